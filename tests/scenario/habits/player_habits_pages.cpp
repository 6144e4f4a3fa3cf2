// SPDX-License-Identifier: Apache-2.0
// Pages over the picture, speed and repeated parts, and a drop.
#include "tests/scenario/habits/player_habits.h"

namespace relievo::test {

void PlayerHabits::pages() {
  const auto covered = [&] { return at(kWidth - 4, 4)[0] < 60; };
  // In a small window the keys are several pages, which their own key turns and then leaves.
  const auto leaves = [&](const std::string& key) {
    for (int presses = 0; presses < 20; ++presses) {
      press(key);
      for (int tries = 0; tries < 50; ++tries) {
        if (!covered()) return true;
        std::this_thread::sleep_for(10ms);
      }
      if (key == "Escape") return false;
    }
    return false;
  };
  for (const char* away : {"Shift_L+slash", "Escape", "h"}) {
    press(std::string(away) == "Escape" ? "F1" : "Shift_L+slash");
    EXPECT_TRUE(until(covered)) << "the page of keys";
    EXPECT_TRUE(leaves(away)) << away;
  }
  EXPECT_EQ(status()["state"], "paused") << "no key of the page has ended the film";
  mouseOnThePage();
  const auto figures = [&] { return at(265, static_cast<int>(200 * kRow))[0] < 120; };  // the ground of their page
  press("i");
  EXPECT_TRUE(until(figures)) << "statistics";
  press("i");
  EXPECT_TRUE(until([&] { return !figures(); }));
}

// The wheel turns the pages, a click closes them; the sound stays as it is.
void PlayerHabits::mouseOnThePage() {
  const auto shown = [&] { return screen_->pixels(place_.x, place_.y, kWidth, kHeight); };
  screen_->moveMouse(place_.x + 160, place_.y + 80);
  press("F1");
  EXPECT_TRUE(until([&] { return at(kWidth - 4, 4)[0] < 60; }));
  const auto first = shown();
  for (const unsigned wheel : {5U, 4U}) {
    click(wheel);
    EXPECT_TRUE(until([&] { return (shown() == first) == (wheel == 4); })) << wheel;
    EXPECT_EQ(status()["volume"], 100);
  }
  click(1);
  EXPECT_TRUE(until([&] { return isFilm(at(kWidth - 4, 4)); })) << "a click";
  EXPECT_EQ(status()["state"], "paused");
}

void PlayerHabits::speedAndLoop() {
  expectAfter("space", "state", "playing");
  expectAfter("bracketleft", "rate", 0.5);
  expectAfter("bracketright", "rate", 1);
  expectAfter("bracketright", "rate", 2);
  expectAfter("BackSpace", "rate", 1);
  EXPECT_TRUE(until([&] { return status()["state"] == "playing"; }));
  press("l");
  EXPECT_TRUE(until([&] { return status()["loop_from_s"].is_number(); }));
  std::this_thread::sleep_for(300ms);  // its end lies after its beginning
  press("l");
  EXPECT_TRUE(until([&] { return status()["loop_to_s"].is_number(); }));
  const auto seconds = [&](const char* what) {
    const json value = status()[what];
    return value.is_number() ? value.get<double>() : 0.0;
  };
  const double from = seconds("loop_from_s"), to = seconds("loop_to_s");
  EXPECT_GT(to, from);
  EXPECT_TRUE(until([&] { return seconds("position_s") < to - 0.1; })) << "again from its beginning";
  expectAfter("l", "loop_from_s", nullptr);
}

void PlayerHabits::aFileIsDropped() {
  ASSERT_TRUE(screen_->drop(window_, folder_ / "dropped.mkv"));
  EXPECT_TRUE(until([&] { return status()["source"] == folder_ / "dropped.mkv"; })) << status();
  show("dropped.mkv - relievo");
}

}  // namespace relievo::test
