// SPDX-License-Identifier: Apache-2.0
// The window display on a private X server: drawings reach the screen, and the viewer's actions on window, keys and
// mouse arrive.
#include <EGL/egl.h>
#include <GLES3/gl3.h>
#include <SDL.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
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

  bool pointsAt(double x_mm, double y_mm) {
    const auto& ray = mouse().ray;
    return ray && glm::distance(ray->screen_mm, glm::dvec2(x_mm, y_mm)) < 1e-9;
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
              {"bracketleft", KEY_LEFTBRACE},
              {"period", KEY_DOT},
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

// On a keyboard of the USA: shift and 3, /, comma.
TEST_F(WindowDisplay, SignsArriveAsWhatIsPrinted) {
  screen_->focus(window_);
  for (const auto& [symbol, code] :
       {std::pair{"3", KEY_NUMERIC_POUND}, {"slash", KEY_QUESTION}, {"comma", KEY_PREVIOUS}}) {
    screen_->key("Shift_L", true);
    EXPECT_EQ(nextKey().code, KEY_LEFTSHIFT);
    screen_->tap(symbol);
    EXPECT_EQ(nextKey().code, code) << symbol;
    EXPECT_EQ(nextKey().code, code) << symbol;
    screen_->key("Shift_L", false);
    EXPECT_EQ(nextKey().code, KEY_LEFTSHIFT);
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

// One millimetre a pixel.
TEST_F(WindowDisplay, TheMouseIsToldByWhatItPointsAt) {
  EXPECT_FALSE(mouse().ray) << "there is no picture yet";
  display_->setViews({.views = {{.half_width_mm = 100, .half_height_mm = 60}}, .screen_z_mm = 20, .depth_mm = 40});
  screen_->moveMouse(place_.x + 150, place_.y + 20);
  EXPECT_TRUE(until([&] { return pointsAt(50.5, 39.5); }));
  EXPECT_EQ(mouse().ray->screen_z_mm, 20);
  display_->setViews({.views = {{.half_width_mm = 200, .half_height_mm = 120}}});
  EXPECT_TRUE(pointsAt(101, 79)) << "the mouse has not moved, the picture has";
  screen_->resize(window_, 300, 150);
  EXPECT_TRUE(until([&] { return pointsAt(400 * (150.5 / 300 - 0.5), 240 * (0.5 - 20.5 / 150)); }))
      << mouse().ray->screen_mm.x << " " << mouse().ray->screen_mm.y;
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

TEST_F(WindowDisplay, FillsTheScreenAndGivesItBack) {
  screen_->focus(window_);
  for (const auto& [asked, wish] :
       {std::pair{FullScreen::Toggle, 1}, {FullScreen::Off, 0}, {FullScreen::On, 1}, {FullScreen::Toggle, 0}}) {
    display_->fillScreen(asked);
    EXPECT_TRUE(until([&] { return screen_->takeFullScreenWish() == wish; })) << wish;
  }
  display_->fillScreen(FullScreen::Off);
  EXPECT_FALSE(until([&, tries = 0]() mutable { return screen_->takeFullScreenWish() || ++tries > 20; }) &&
               screen_->takeFullScreenWish())
      << "it is off already";
}

TEST_F(WindowDisplay, ADoubleClickAsksForTheWholeScreen) {
  screen_->focus(window_);
  screen_->moveMouse(place_.x + 50, place_.y + 50);
  for (int click = 0; click < 2; ++click) {
    EXPECT_EQ(screen_->takeFullScreenWish(), std::nullopt);
    screen_->button(1, true);
    EXPECT_TRUE(until([&] { return mouse().left; }));
    screen_->button(1, false);
    EXPECT_TRUE(until([&] { return !mouse().left; }));
  }
  EXPECT_TRUE(until([&] { return screen_->takeFullScreenWish() == 1; }));
}

TEST_F(WindowDisplay, OtherMouseButtonsAreKeys) {
  screen_->focus(window_);
  screen_->moveMouse(place_.x + 50, place_.y + 50);
  for (const auto& [button, code] : {std::pair{3U, KEY_PLAYPAUSE}, {8U, KEY_PREVIOUS}, {9U, KEY_NEXT}}) {
    screen_->button(button, true);
    screen_->button(button, false);
    std::optional<KeyEvent> press;
    EXPECT_TRUE(until([&] { return (press = input_->keys.tryPop()).has_value(); })) << button;
    ASSERT_TRUE(press);
    EXPECT_EQ(press->code, code);
    EXPECT_EQ(press->action, KeyEvent::Action::Press);
    const auto release = input_->keys.tryPop();
    ASSERT_TRUE(release);
    EXPECT_EQ(release->action, KeyEvent::Action::Release);
  }
}

// As for the list of films, before there is a film. The screen is 640 x 480.
TEST_F(WindowDisplay, BeforeAFilmItFitsTheScreenInItsShape) {
  const auto other = makeWindowDisplay(std::make_shared<WindowInput>(), clock_);
  ASSERT_TRUE(other->open({.width = 1280, .height = 720, .fits_desktop = true}));
  other->announce({"the list", 0, 0});
  ASSERT_TRUE(other->beginFrame() && other->present());
  const unsigned long window = screen_->find("the list - relievo");
  EXPECT_TRUE(until([&] { return screen_->place(window)->width == 608 && screen_->place(window)->height == 342; }))
      << screen_->place(window)->width;
  other->close();
  ASSERT_TRUE(other->open({.width = 1280, .height = 720, .film_size = true}));
  other->announce({"a tall film", 1000, 1000});
  ASSERT_TRUE(other->beginFrame() && other->present());
  const unsigned long tall = screen_->find("a tall film - relievo");
  EXPECT_TRUE(until([&] { return screen_->place(tall)->height == 442; })) << screen_->place(tall)->height;
  EXPECT_EQ(screen_->place(tall)->width, 442) << "a title of 38 pixels finds room";
}

TEST_F(WindowDisplay, WithAFilmsSizeItComesUpWithTheFirstFrame) {
  const auto other = makeWindowDisplay(std::make_shared<WindowInput>(), clock_);
  ASSERT_TRUE(other->open({.width = 64, .height = 64, .film_size = true}));
  other->announce({"a long film.mkv", 240, 100});
  ASSERT_TRUE(other->beginFrame());
  ASSERT_TRUE(other->present());
  const unsigned long window = screen_->find("a long film.mkv - relievo");
  ASSERT_NE(window, 0u);
  EXPECT_TRUE(until([&] { return screen_->place(window)->width == 240 && screen_->place(window)->height == 100; }));
  other->announce({"larger than the screen", 6400, 3200});
  EXPECT_TRUE(until([&] { return screen_->place(window)->width == 608 && screen_->place(window)->height == 304; }))
      << screen_->place(window)->width;
  screen_->resize(window, 300, 200);
  EXPECT_TRUE(until([&] {
    const auto surface = other->beginFrame();
    const bool now = surface && surface->width == 300;
    EXPECT_TRUE(other->present());
    return now && other->attend();
  }));
  other->announce({"the next film", 240, 100});
  EXPECT_NE(screen_->find("the next film - relievo"), 0u);
  EXPECT_EQ(screen_->place(window)->width, 300) << "as the viewer has made it";
}

// 192 dpi: everything is drawn twice as large.
TEST_F(WindowDisplay, AFilmsSizeIsThatOfTheDesktopsPoints) {
  screen_->setResources("Xft.dpi:\t192\n");
  const auto input = std::make_shared<WindowInput>();
  const auto other = makeWindowDisplay(input, clock_);
  ASSERT_TRUE(other->open({.width = 64, .height = 64, .film_size = true}));
  other->announce({"fine.mkv", 240, 100});
  const auto surface = other->beginFrame();
  ASSERT_TRUE(surface && other->present());
  const unsigned long window = screen_->find("fine.mkv - relievo");
  EXPECT_TRUE(until([&] { return screen_->place(window)->width == 480 && screen_->place(window)->height == 200; }));
  std::optional<SurfaceMouse> mouse;
  other->hearMouse([&](const SurfaceMouse& at) {
    mouse = at;
    return true;
  });
  const auto place = *screen_->place(window);
  screen_->moveMouse(place.x + 120, place.y + 150);
  EXPECT_TRUE(until([&] { return other->attend() && mouse && std::abs(mouse->down - 0.75) < 0.01; }));
  EXPECT_NEAR(mouse->across, 0.25, 0.01);
  other->close();
  screen_->setResources("Xft.dpi:\t120\n");
  ASSERT_TRUE(other->open({.width = 64, .height = 64, .film_size = true}));
  other->announce({"usual.mkv", 240, 100});
  ASSERT_TRUE(other->beginFrame() && other->present());
  const unsigned long usual = screen_->find("usual.mkv - relievo");
  EXPECT_TRUE(until([&] { return screen_->place(usual)->width == 240; }));
  screen_->setResources("");
}

TEST_F(WindowDisplay, WhatIsDroppedOnItIsTold) {
  EXPECT_TRUE(display_->takeDropped().empty());
  for (const char* path : {"/films/a b.mkv", "/films/c.mkv"}) {
    SDL_Event event{};
    event.drop = {.type = SDL_DROPFILE, .timestamp = 0, .file = SDL_strdup(path), .windowID = 1};
    ASSERT_EQ(SDL_PushEvent(&event), 1);
  }
  ASSERT_TRUE(display_->attend());
  EXPECT_EQ(display_->takeDropped(), (std::vector<std::string>{"/films/a b.mkv", "/films/c.mkv"}));
  EXPECT_TRUE(display_->takeDropped().empty());
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
