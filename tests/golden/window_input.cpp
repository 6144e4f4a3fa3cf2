// SPDX-License-Identifier: Apache-2.0
// The window on a desktop: its keys, its mouse, and what is dropped on it.
#include <SDL.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/egl/egl.h"
#include "drivers/egl/window_keys.h"
#include "drivers/window/window_input.h"
#include "hal/key_names.h"
#include "tests/golden/window_display.h"
#include "tests/support/machine/x_screen.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;
using Action = KeyEvent::Action;

TEST(WindowKeys, WithoutATextShiftMakesWhatItMakesInTheUsa) {
  SDL_Keysym slash{};
  slash.scancode = SDL_SCANCODE_SLASH;
  slash.sym = SDLK_SLASH;
  EXPECT_EQ(linuxKey(slash, ""), KEY_SLASH);
  slash.mod = KMOD_LSHIFT;
  EXPECT_EQ(linuxKey(slash, ""), KEY_QUESTION);
  EXPECT_EQ(linuxKey(slash, "_"), KEY_MINUS | kWithShift) << "as in Germany";
  SDL_Keysym seven{};
  seven.scancode = SDL_SCANCODE_7;
  seven.sym = SDLK_7;
  seven.mod = KMOD_LSHIFT;
  EXPECT_EQ(linuxKey(seven, ""), KEY_7 | kWithShift) << "&";
  EXPECT_EQ(linuxKey(seven, "7"), KEY_NUMERIC_7) << "as in France";
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

// With AltGr and Shift, where a German and a French keyboard have them; as in other players, what is typed counts.
TEST_F(WindowDisplay, SignsAreThoseThatTheLayoutMakes) {
  constexpr auto kNone = static_cast<int>(KEY_RESERVED);
  const struct {
    const char *layout, *held, *symbol;
    int held_code, code;
  } keys[] = {{"de", "ISO_Level3_Shift", "q", KEY_RIGHTALT, KEY_2 | kWithShift},  // @
              {"de", "ISO_Level3_Shift", "8", KEY_RIGHTALT, KEY_LEFTBRACE},
              {"de", "ISO_Level3_Shift", "9", KEY_RIGHTALT, KEY_RIGHTBRACE},
              {"de", "Shift_L", "ssharp", KEY_LEFTSHIFT, KEY_QUESTION},
              {"de", "Shift_L", "less", KEY_LEFTSHIFT, KEY_NEXT},
              {"de", "Shift_L", "2", KEY_LEFTSHIFT, KEY_APOSTROPHE | kWithShift},  // "
              {"de", "Shift_L", "7", KEY_LEFTSHIFT, KEY_SLASH},
              {"de", "Control_L", "plus", KEY_LEFTCTRL, KEY_KPPLUS},
              {"de", nullptr, "less", kNone, KEY_PREVIOUS},
              {"de", nullptr, "KP_Divide", kNone, KEY_KPSLASH},
              {"de", nullptr, "z", kNone, KEY_Z},
              {"fr", "Shift_L", "ampersand", KEY_LEFTSHIFT, KEY_NUMERIC_1},
              {"de", nullptr, "ssharp", kNone, KEY_UNKNOWN},
              {"de", nullptr, "udiaeresis", kNone, KEY_UNKNOWN},
              {"de", "Control_L", "odiaeresis", KEY_LEFTCTRL, KEY_UNKNOWN},
              {"de", nullptr, "dead_acute", kNone, KEY_UNKNOWN},
              {"de", "ISO_Level3_Shift", "e", KEY_RIGHTALT, KEY_UNKNOWN},  // the euro's sign
              {"us", "Shift_L", "7", KEY_LEFTSHIFT, KEY_7 | kWithShift},
              {"fr", nullptr, "ampersand", kNone, KEY_7 | kWithShift},
              {"fr", nullptr, "a", kNone, KEY_A},
              {"ru", nullptr, "Cyrillic_ef", kNone, KEY_A}};
  screen_->focus(window_);
  for (const auto& [layout, held, symbol, held_code, code] : keys) {
    if (!screen_->setLayout(layout)) GTEST_SKIP() << "setxkbmap is missing (Debian: x11-xkb-utils)";
    if (held != nullptr) {
      screen_->key(held, true);
      EXPECT_EQ(nextKey().code, held_code) << layout << held;
    }
    screen_->key(symbol, true);
    EXPECT_EQ(nextKey().code, code) << layout << " " << symbol;
    if (held != nullptr) {
      screen_->key(held, false);
      EXPECT_EQ(nextKey().code, held_code) << layout << held;
    }
    screen_->key(symbol, false);
    EXPECT_EQ(nextKey().code, code) << layout << " " << symbol << ", let go after the other";
  }
  EXPECT_TRUE(screen_->setLayout("us"));
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

// It lies at (200, 190) first, and then around the same middle at (120, 90).
TEST_F(WindowDisplay, AMouseAtRestIsWhereTheWindowComesToLieBeneathIt) {
  const auto input = std::make_shared<WindowInput>();
  const auto other = makeWindowDisplay(input, clock_);
  screen_->moveMouse(250, 230);
  ASSERT_TRUE(other->open({.width = 64, .height = 64, .film_size = true}));
  const auto isAfter = [&](int width, int height, glm::dvec2 at_mm) {
    other->announce({"film", width, height});
    EXPECT_TRUE(other->beginFrame() && other->present());
    other->setViews({.views = {{.half_width_mm = 0.5 * width, .half_height_mm = 0.5 * height}}});
    std::optional<SceneRay> ray;
    return until([&] {
      EXPECT_TRUE(other->attend());
      input->mouse.refresh();
      ray = input->mouse.front().ray;
      return ray && glm::distance(ray->screen_mm, at_mm) < 1e-9;
    });
  };
  EXPECT_TRUE(isAfter(240, 100, {50.5 - 120, 50 - 40.5}));
  EXPECT_TRUE(isAfter(400, 300, {130.5 - 200, 150 - 140.5}));
}

TEST_F(WindowDisplay, ThePointerIsSeenWhileTheMouseMoves) {
  const auto seen = [&] {
    EXPECT_TRUE(display_->attend());
    return SDL_ShowCursor(SDL_QUERY) == SDL_ENABLE;
  };
  EXPECT_TRUE(seen());
  for (const auto fill : {FullScreen::Off, FullScreen::On}) {
    display_->fillScreen(fill);
    EXPECT_TRUE(until([&] {
      clock_.advance(3s);  // full screen moves the mouse
      return !seen();
    }));
    screen_->moveMouse(place_.x + 50, place_.y + (fill == FullScreen::On ? 60 : 50));
    EXPECT_TRUE(until(seen));
    clock_.advance(1900ms);
    EXPECT_TRUE(seen());
    clock_.advance(200ms);
    EXPECT_FALSE(seen());
  }
  display_.reset();
  while (screen_->takeFullScreenWish()) continue;  // nothing is left to the next test
}

TEST_F(WindowDisplay, ADoubleClickAsksForTheWholeScreenAndAFastSecondOneGivesItBack) {
  screen_->focus(window_);
  screen_->moveMouse(place_.x + 50, place_.y + 50);
  for (const int wish : {1, 0}) {
    for (int click = 0; click < 2; ++click) {
      EXPECT_EQ(screen_->takeFullScreenWish(), std::nullopt) << wish;
      screen_->button(1, true);
      EXPECT_TRUE(until([&] { return mouse().left; }));
      screen_->button(1, false);
      EXPECT_TRUE(until([&] { return !mouse().left; }));
    }
    EXPECT_TRUE(until([&] { return screen_->takeFullScreenWish() == wish; })) << wish;
  }
}

// As over the list of films, where the key for a pause would play one.
TEST_F(WindowDisplay, TheRightButtonIsNoKeyWhereThePlayerTakesTheMouse) {
  display_->hearMouse([](const SurfaceMouse&) { return true; });
  screen_->focus(window_);
  screen_->moveMouse(place_.x + 50, place_.y + 50);
  for (const unsigned button : {3U, 8U}) {
    screen_->button(button, true);
    screen_->button(button, false);
  }
  EXPECT_EQ(nextKey().code, KEY_PREVIOUS) << "the button at the side";
}

// Of a window that comes up under a mouse at rest, the press is the first that is heard.
TEST_F(WindowDisplay, TheRightButtonIsToldWhereItIsPressed) {
  bool told = false;
  display_->hearMouse([&](const SurfaceMouse& mouse) {
    told = told || std::pair(mouse.across, mouse.down) == std::pair(150.5 / kWidth, 20.5 / kHeight);
    return true;
  });
  SDL_Event event{};
  event.button.type = SDL_MOUSEBUTTONDOWN;
  event.button.windowID = SDL_GetWindowID(SDL_GL_GetCurrentWindow());
  event.button.button = SDL_BUTTON_RIGHT;
  event.button.state = SDL_PRESSED;
  event.button.x = 150;
  event.button.y = 20;
  ASSERT_EQ(SDL_PushEvent(&event), 1);
  ASSERT_TRUE(display_->attend());
  EXPECT_TRUE(told);
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

}  // namespace
}  // namespace relievo::test
