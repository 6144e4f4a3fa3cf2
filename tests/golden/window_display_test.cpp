// SPDX-License-Identifier: Apache-2.0
// The window display on a private X server: drawings reach the screen, and the viewer's actions on window, keys and
// mouse arrive.
#include <EGL/egl.h>
#include <GLES3/gl3.h>
#include <SDL.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <array>
#include <functional>
#include <thread>
#include <vector>

#include "drivers/egl/egl.h"
#include "drivers/window/window_input.h"
#include "tests/support/machine/x_screen.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using Rgb = std::array<int, 3>;
using Action = KeyEvent::Action;

void fill(int x, int y, int width, int height, float red, float green, float blue) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(x, y, width, height);
  glClearColor(red, green, blue, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

// Runs first, before any display has been opened.
TEST(WindowDisplayMade, StartsNothingBeforeItIsOpened) {
  const ManualClock clock;
  const auto input = std::make_shared<WindowInput>();
  const auto display = makeWindowDisplay(input, clock);
  EXPECT_STREQ(display->capabilities().name, "window");
  EXPECT_EQ(SDL_WasInit(SDL_INIT_EVERYTHING), 0u);
  EXPECT_FALSE(input->open);
}

class WindowDisplay : public testing::Test {
 protected:
  static constexpr int kWidth = 200, kHeight = 120;

  static void SetUpTestSuite() { screen_ = test::XScreen::start(); }
  static void TearDownTestSuite() { screen_.reset(); }
  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << test::kNoXServer;
    const auto opened = display_->open({kWidth, kHeight});
    ASSERT_TRUE(opened) << opened.error().message;
    window_ = screen_->find("relievo");
    ASSERT_NE(window_, 0u);
    place_ = *screen_->place(window_);
    ASSERT_TRUE(until([&] { return redraw_; })) << "a window that has just come up is to be drawn";
    redraw_ = false;
  }

  // Each corner in its own colour, upper left first: red, green, blue, white.
  void drawCorners() {
    const auto surface = display_->beginFrame();
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->framebuffer, 0u);
    const int w = surface->width / 2, h = surface->height / 2;
    fill(0, h, w, h, 1, 0, 0);
    fill(w, h, w, h, 0, 1, 0);
    fill(0, 0, w, h, 0, 0, 1);
    fill(w, 0, w, h, 1, 1, 1);
    const auto shown = display_->present();
    ASSERT_TRUE(shown);
    EXPECT_LE(*shown, display_->capabilities().refresh_period);
  }
  // Polls, because X and SDL exchange messages asynchronously.
  bool until(const std::function<bool()>& so) {
    for (int tries = 0; tries < 2000; ++tries) {
      if (so()) return true;
      const auto redraw = display_->attend();
      redraw_ = redraw_ || (redraw && *redraw);
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }
  bool untilPixel(int x, int y, const Rgb& color) {
    return until([&] { return screen_->pixel(place_.x + x, place_.y + y) == color; });
  }
  KeyEvent nextKey() {
    std::optional<KeyEvent> key;
    EXPECT_TRUE(until([&] { return (key = input_->keys.tryPop()).has_value(); })) << "no key came";
    return key.value_or(KeyEvent{});
  }
  const WindowMouse& mouse() {
    input_->mouse.refresh();
    return input_->mouse.front();
  }

  static std::unique_ptr<test::XScreen> screen_;
  ManualClock clock_{MonotonicTime(1h)};
  std::shared_ptr<WindowInput> input_ = std::make_shared<WindowInput>();
  std::unique_ptr<Display> display_ = makeWindowDisplay(input_, clock_);
  unsigned long window_ = 0;
  test::XScreen::Place place_;
  bool redraw_ = false;
};
std::unique_ptr<test::XScreen> WindowDisplay::screen_;

TEST_F(WindowDisplay, OnTheScreenIsWhatWasDrawn) {
  EXPECT_EQ(place_.width, kWidth);
  EXPECT_EQ(place_.height, kHeight);
  drawCorners();
  EXPECT_TRUE(untilPixel(0, 0, {255, 0, 0}));
  const struct {
    int x, y;
    Rgb color;
  } expected[] = {{99, 59, {255, 0, 0}},  {100, 59, {0, 255, 0}},     {199, 0, {0, 255, 0}},      {0, 60, {0, 0, 255}},
                  {99, 119, {0, 0, 255}}, {100, 60, {255, 255, 255}}, {199, 119, {255, 255, 255}}};
  for (const auto& [x, y, color] : expected) {
    EXPECT_EQ(screen_->pixel(place_.x + x, place_.y + y), color) << x << "," << y;
  }
}

TEST_F(WindowDisplay, DrawsWithGles3ThroughEgl) {
  ASSERT_TRUE(display_->beginFrame());
  EXPECT_NE(eglGetCurrentContext(), EGL_NO_CONTEXT);
  EXPECT_TRUE(std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))).starts_with("OpenGL ES 3"));
  GLint depth_bits = 0;
  glGetIntegerv(GL_DEPTH_BITS, &depth_bits);
  EXPECT_GE(depth_bits, 16);
}

TEST_F(WindowDisplay, TheSurfaceFollowsTheWindow) {
  drawCorners();
  screen_->resize(window_, 300, 150);
  EXPECT_TRUE(until([&] {
    const auto surface = display_->beginFrame();
    const bool now = surface && surface->width == 300 && surface->height == 150;
    EXPECT_TRUE(display_->present());
    return now;
  }));
  EXPECT_TRUE(redraw_) << "the film may stand";
  drawCorners();
  EXPECT_TRUE(untilPixel(299, 149, {255, 255, 255}));
  EXPECT_EQ(screen_->pixel(place_.x + 149, place_.y + 0), (Rgb{255, 0, 0}));
  EXPECT_TRUE(until([&] { return mouse().width_px == 300 && mouse().height_px == 150; }))
      << "so does the mouse's place";
}

TEST_F(WindowDisplay, UncoveredItIsToBeDrawnAnew) {
  drawCorners();
  {
    const auto other = makeWindowDisplay(std::make_shared<WindowInput>(), clock_);
    ASSERT_TRUE(other->open({kWidth, kHeight}));
    ASSERT_TRUE(until([&] { return true; }));
    redraw_ = false;
  }
  EXPECT_TRUE(until([&] { return redraw_; }));
}

TEST_F(WindowDisplay, KeysArriveWithTheCodesOfLinux) {
  screen_->focus(window_);
  const struct {
    const char* symbol;
    int code;
  } keys[] = {{"space", KEY_SPACE},
              {"Right", KEY_RIGHT},
              {"Left", KEY_LEFT},
              {"Return", KEY_ENTER},
              {"Escape", KEY_ESC},
              {"s", KEY_S},
              {"F1", KEY_F1},
              {"KP_Enter", KEY_KPENTER},
              {"0", KEY_0},
              {"Page_Up", KEY_PAGEUP},
              {"XF86AudioPlay", KEY_PLAYPAUSE}};
  for (const auto& [symbol, code] : keys) {
    clock_.advance(1s);
    screen_->tap(symbol);
    const KeyEvent down = nextKey(), up = nextKey();
    EXPECT_EQ(down.code, code) << symbol;
    EXPECT_EQ(down.action, Action::Press) << symbol;
    EXPECT_EQ(down.time, clock_.now());
    EXPECT_EQ(up.code, code) << symbol;
    EXPECT_EQ(up.action, Action::Release) << symbol;
  }
}

TEST_F(WindowDisplay, AHeldKeyRepeatsUntilItIsLetGo) {
  screen_->focus(window_);
  screen_->key("Right", true);
  EXPECT_EQ(nextKey().action, Action::Press);
  EXPECT_EQ(nextKey().action, Action::Repeat);
  EXPECT_EQ(nextKey().action, Action::Repeat);
  screen_->key("Right", false);
  KeyEvent last;
  EXPECT_TRUE(until([&] {
    while (const auto key = input_->keys.tryPop()) last = *key;
    return last.action == Action::Release;
  }));
}

TEST_F(WindowDisplay, TheMouseIsToldFromTheMiddleUpAndToTheRight) {
  screen_->moveMouse(place_.x + 150, place_.y + 20);
  EXPECT_TRUE(until([&] { return mouse().right_px == 50.5; }));
  EXPECT_EQ(mouse().up_px, 39.5);
  EXPECT_EQ(mouse().width_px, kWidth);
  EXPECT_EQ(mouse().height_px, kHeight);
  for (const unsigned wheel : {4u, 4u, 4u, 5u}) {
    screen_->button(wheel, true);
    screen_->button(wheel, false);
  }
  EXPECT_TRUE(until([&] { return mouse().notches == 2; })) << mouse().notches;
  const auto down = [&] { return std::array{mouse().left, mouse().middle, mouse().right}; };
  const std::array<bool, 3> none{};
  for (unsigned button = 1; button <= 3; ++button) {
    std::array<bool, 3> one{};
    one[button - 1] = true;
    screen_->button(button, true);
    EXPECT_TRUE(until([&] { return down() == one; })) << button;
    screen_->button(button, false);
    EXPECT_TRUE(until([&] { return down() == none; })) << button;
  }
}

TEST_F(WindowDisplay, F11AsksForTheWholeScreenAndGivesItBack) {
  for (const int wish : {1, 0, 1}) {
    screen_->focus(window_);
    screen_->tap("F11");
    EXPECT_TRUE(until([&] { return screen_->takeFullScreenWish() == wish; })) << wish;
  }
  EXPECT_FALSE(input_->keys.tryPop()) << "the key is the window's own";
}

TEST_F(WindowDisplay, TheCloseButtonIsTheViewersWord) {
  ASSERT_TRUE(display_->attend());
  screen_->askToClose(window_);
  EXPECT_TRUE(until([&] {
    const auto attended = display_->attend();
    return !attended && attended.error().code == ErrorCode::Cancelled;
  }));
  display_->close();
  ASSERT_TRUE(display_->open({kWidth, kHeight}));
  EXPECT_TRUE(display_->attend()) << "said of the window that was";
  display_->close();
  EXPECT_FALSE(input_->open);
}

TEST_F(WindowDisplay, WhatTwoWindowsHearIsNotMixedUp) {
  const auto input = std::make_shared<WindowInput>();
  const auto other = makeWindowDisplay(input, clock_);
  ASSERT_TRUE(other->open({50, 50}));
  screen_->focus(window_);
  screen_->tap("a");
  std::optional<KeyEvent> key;
  EXPECT_TRUE(until([&] { return other->attend() && (key = input_->keys.tryPop()); })) << "whichever is attended to";
  EXPECT_EQ(key.value_or(KeyEvent{}).code, KEY_A);
  EXPECT_FALSE(input->keys.tryPop());
}

TEST_F(WindowDisplay, DrawsOnWhenAnotherContextWasCurrentMeanwhile) {
  const auto offscreen = makeOffscreenDisplay({}, clock_);
  ASSERT_TRUE(offscreen->open({16, 16}));
  drawCorners();
  ASSERT_TRUE(offscreen->beginFrame());
  fill(0, 0, 16, 16, 0, 0, 0);
  ASSERT_TRUE(offscreen->present());
  drawCorners();
  EXPECT_TRUE(untilPixel(0, 0, {255, 0, 0}));
}

TEST_F(WindowDisplay, OpensAgainAHundredTimes) {
  for (int round = 0; round < 100; ++round) {
    display_->close();
    ASSERT_TRUE(display_->open({64, 64})) << round;
    ASSERT_TRUE(display_->beginFrame());
    fill(0, 0, 64, 64, 1, 0, 0);
    ASSERT_TRUE(display_->present());
  }
}

}  // namespace
}  // namespace relievo
