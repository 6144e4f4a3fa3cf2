// SPDX-License-Identifier: Apache-2.0
// The window on a desktop: what it shows, its size, and how it is opened and closed.
#include <EGL/egl.h>
#include <GLES3/gl3.h>
#include <SDL.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <cmath>
#include <optional>
#include <string>

#include "drivers/egl/egl.h"
#include "drivers/window/window_input.h"
#include "tests/golden/window_display.h"
#include "tests/support/machine/x_screen.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;

// Runs first, before any display has been opened.
TEST(WindowDisplayMade, StartsNothingBeforeItIsOpened) {
  const ManualClock clock;
  const auto input = std::make_shared<WindowInput>();
  const auto display = makeWindowDisplay(input, clock);
  EXPECT_STREQ(display->capabilities().name, "window");
  EXPECT_EQ(SDL_WasInit(SDL_INIT_EVERYTHING), 0u);
  EXPECT_FALSE(input->open);
}

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

TEST_F(WindowDisplay, MinimisedItStaysSoWhileTheFilmPlays) {
  drawCorners();
  screen_->hide(window_);
  EXPECT_TRUE(until([&, frames = 0]() mutable {
    drawCorners();
    EXPECT_FALSE(screen_->isShown(window_)) << "frame " << frames;
    return ++frames == 20;
  }));
}

// A film shows a picture every few seconds at least, as a slide show; paused, or in the list of films, none changes.
TEST_F(WindowDisplay, KeepsTheScreenAwakeOnlyWhilePicturesCome) {
  const auto may_blank = [&](Duration later) {
    clock_.advance(later);
    EXPECT_TRUE(display_->attend());
    return SDL_IsScreenSaverEnabled() == SDL_TRUE;
  };
  EXPECT_TRUE(may_blank(0s));
  for (int picture = 0; picture < 3; ++picture) {
    drawCorners();
    EXPECT_FALSE(may_blank(14s));
  }
  EXPECT_TRUE(may_blank(2s));
  drawCorners();
  EXPECT_FALSE(may_blank(0s));
  display_->close();
  EXPECT_EQ(SDL_IsScreenSaverEnabled(), SDL_TRUE);
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

// As under a window manager, which moves the window while SDL waits for it.
TEST_F(WindowDisplay, TheMouseStaysWhereItIsWhileTheWindowFillsTheScreen) {
  const std::array<int, 2> there{place_.x + 150, place_.y + 90};
  display_->setViews({.views = {{.half_width_mm = 100, .half_height_mm = 60}}});
  screen_->moveMouse(there[0], there[1] - 50);
  ASSERT_TRUE(until([&] { return pointsAt(50.5, 19.5); }));
  screen_->moveMouse(there[0], there[1]);  // nobody has heard of that yet
  {
    const std::jthread manager([&] {
      for (int tries = 0; screen_->takeFullScreenWish() != 1 && tries < 5000; ++tries) std::this_thread::sleep_for(1ms);
      screen_->move(window_, {0, 0, XScreen::kWidth, XScreen::kHeight});
    });
    display_->fillScreen(FullScreen::On);
  }
  EXPECT_TRUE(until([&] { return screen_->place(window_)->width == XScreen::kWidth; }));
  EXPECT_EQ(screen_->mouse(), there);
  const double right = (there[0] + 0.5) / XScreen::kWidth - 0.5, up = 0.5 - (there[1] + 0.5) / XScreen::kHeight;
  EXPECT_TRUE(until([&] { return pointsAt(200 * right, 120 * up); }))
      << mouse().ray->screen_mm.x << " " << mouse().ray->screen_mm.y;
  display_.reset();
  EXPECT_EQ(screen_->takeFullScreenWish(), 0) << "not left to the next test";
}

TEST_F(WindowDisplay, AWindowThatMovesBeneathAStillMouseTellsWhatItPointsAtNow) {
  const int x = place_.x + 150, y = place_.y + 90;
  display_->setViews({.views = {{.half_width_mm = 100, .half_height_mm = 60}}});
  screen_->moveMouse(x, y);
  ASSERT_TRUE(until([&] { return pointsAt(50.5, -30.5); }));
  screen_->move(window_, {100, 150, 400, 240});
  EXPECT_TRUE(until([&] { return pointsAt(200 * ((x - 99.5) / 400 - 0.5), 120 * (0.5 - (y - 149.5) / 240)); }))
      << mouse().ray->screen_mm.x << " " << mouse().ray->screen_mm.y;
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

// As in other players, also without a window manager.
TEST_F(WindowDisplay, TheNextFilmLeavesTheWindowWhereTheViewerHasMovedIt) {
  const auto other = makeWindowDisplay(std::make_shared<WindowInput>(), clock_);
  ASSERT_TRUE(other->open({.width = 64, .height = 64, .film_size = true}));
  const auto plays = [&](const char* title, int width, int height) {
    other->announce({title, width, height});
    ASSERT_TRUE(other->beginFrame());
    ASSERT_TRUE(other->present());
    ASSERT_TRUE(other->attend());
  };
  plays("first", 240, 100);
  const unsigned long window = screen_->find("first - relievo");
  ASSERT_NE(window, 0u);
  const auto lies = [&](const XScreen::Place& at) {
    return until([&] {
      const auto place = screen_->place(window).value_or(XScreen::Place{});
      return other->attend() && place.x == at.x && place.y == at.y && place.width == at.width &&
             place.height == at.height;
    });
  };
  EXPECT_TRUE(lies({200, 190, 240, 100})) << "in the middle";
  screen_->move(window, {100, 60, 240, 100});
  EXPECT_TRUE(lies({100, 60, 240, 100}));
  std::this_thread::sleep_for(100ms);
  ASSERT_TRUE(other->attend());
  plays("second", 240, 100);
  EXPECT_TRUE(lies({100, 60, 240, 100}));
  plays("third", 200, 120);
  EXPECT_TRUE(lies({120, 50, 200, 120}));
  plays("fourth", 400, 300);
  EXPECT_TRUE(lies({20, 19, 400, 300})) << "around its middle, but whole";
  other->fillScreen(FullScreen::On);
  EXPECT_TRUE(until([&] {
    clock_.advance(100ms);
    return other->attend() && screen_->place(window)->width == XScreen::kWidth;
  }));
  plays("fifth", 240, 100);
  EXPECT_EQ(screen_->place(window)->width, XScreen::kWidth) << "it fills the screen";
  other->fillScreen(FullScreen::Off);
  EXPECT_TRUE(lies({100, 119, 240, 100})) << "around the middle that it had before";
  other->fillScreen(FullScreen::On);  // a window manager would now do it
  plays("sixth", 200, 60);
  other->fillScreen(FullScreen::Off);
  EXPECT_TRUE(lies({120, 139, 200, 60}));
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
}  // namespace relievo::test
