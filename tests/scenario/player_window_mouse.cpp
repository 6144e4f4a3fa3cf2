// SPDX-License-Identifier: Apache-2.0
// What a viewer does with the mouse in the window.
#include <array>

#include "tests/scenario/player_window.h"
#include "tests/support/machine/control_client.h"

namespace relievo::test {
namespace {

using nlohmann::json;

// In the finger's colour, over the bar where the mouse is and nowhere else.
TEST_F(PlayerWindow, TheMouseOverTheBarShowsItsTime) {
  const auto player = play({"--haptic", "none"});
  EXPECT_TRUE(until([&] { return shows(); }));
  const auto colored = [&](int from, int to) {
    for (int y = static_cast<int>(624.0 / 720 * kHeight); y < static_cast<int>(646.0 / 720 * kHeight); ++y) {
      for (int x = from; x < to; ++x) {
        const auto [red, green, blue] = screen_->pixel(place_.x + x, place_.y + y);
        if (red > blue + 50) return true;
      }
    }
    return false;
  };
  screen_->moveMouse(place_.x + 240, place_.y + static_cast<int>(664.0 / 720 * kHeight));
  EXPECT_TRUE(until([&] { return colored(225, 256); }));
  EXPECT_FALSE(colored(20, 200));
  screen_->moveMouse(place_.x + 240, place_.y + 60);
  EXPECT_TRUE(until([&] { return !colored(225, 256); }));
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
}

// The wall is 20 mm high. The finger is where the mouse points (half a millimetre a pixel) and presses into it there.
TEST_F(PlayerWindow, ItsMouseIsTheFinger) {
  const auto player = play({"--haptic", "pointer", "--record", folder_ / "t.csv"});
  EXPECT_TRUE(until([&] { return shows(); }));
  screen_->moveMouse(place_.x + 220, place_.y + 80);
  screen_->button(1, true);
  std::this_thread::sleep_for(1500ms);  // 26 mm at 80 mm/s
  screen_->button(1, false);
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  EXPECT_GT(report()["force"]["max_n"].get<double>(), 0.5) << textOf("said.txt");
  std::istringstream csv(textOf("t.csv"));
  std::string line, touching;
  while (std::getline(csv, line)) {
    if (line.find(",1,") != std::string::npos) touching = line;
  }
  std::istringstream row(touching);
  std::array<double, 4> place{};
  char comma = 0;
  row >> place[0] >> comma >> place[1] >> comma >> place[2] >> comma >> place[3];
  EXPECT_NEAR(place[1], 60 * 0.5, 0.5) << touching;
  EXPECT_NEAR(place[2], 40 * 0.5, 0.5) << touching;
}

// The bar comes when the mouse is near its place; it is pressed, dragged and let go, and no finger feels that.
TEST_F(PlayerWindow, ItsBarIsPressedAndDragged) {
  const auto player = play({"--haptic", "pointer"});
  EXPECT_TRUE(until([&] { return shows(); }));
  const int height = place_.y + static_cast<int>(664.0 / 720 * kHeight);
  screen_->moveMouse(place_.x + 240, height);
  std::this_thread::sleep_for(300ms);
  screen_->button(1, true);
  std::this_thread::sleep_for(300ms);
  screen_->moveMouse(place_.x + 160, height);
  std::this_thread::sleep_for(300ms);
  screen_->button(1, false);
  screen_->moveMouse(place_.x + 60, height);  // no longer held
  std::this_thread::sleep_for(300ms);
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  const json r = report();
  ASSERT_EQ(r["seeks"].size(), 2u) << r["seeks"];
  constexpr double kMargin = 40.0 / 720 * kHeight, kLength = 2;
  EXPECT_NEAR(r["seeks"][0]["target_s"].get<double>(), (240.5 - kMargin) / (kWidth - 2 * kMargin) * kLength, 0.02);
  EXPECT_NEAR(r["seeks"][1]["target_s"].get<double>(), (160.5 - kMargin) / (kWidth - 2 * kMargin) * kLength, 0.02);
  EXPECT_EQ(r["force"]["max_n"].get<double>(), 0) << "the press is the bar's, not the finger's";
}

// For whoever has a mouse alone. The view is 960 units wide; "Pause", "3D", "Full screen" and "?" end at its margin.
TEST_F(PlayerWindow, AWordOfItsBarIsClicked) {
  const auto player = play({"--haptic", "pointer"});
  EXPECT_TRUE(until([&] { return shows(); }));
  const auto click = [&](double across) {
    screen_->moveMouse(place_.x + static_cast<int>(across / 960 * kWidth),
                       place_.y + static_cast<int>(597.0 / 720 * kHeight));
    std::this_thread::sleep_for(300ms);
    screen_->button(1, true);
    std::this_thread::sleep_for(300ms);
    screen_->button(1, false);
    std::this_thread::sleep_for(300ms);
  };
  click(590);  // "Pause"
  click(670);  // "3D"
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  const json r = report();
  EXPECT_EQ(r["states"], (json{"boot", "idle", "opening", "buffering", "playing", "paused", "idle"}));
  EXPECT_EQ(r["video"]["stereo"], "sbs") << "the next one after mono";
  EXPECT_EQ(r["force"]["max_n"].get<double>(), 0) << "the press is the bar's, not the finger's";
}

TEST_F(PlayerWindow, APressOfAWordThatSlidesOntoTheBarSeeksNothing) {
  const auto player = play({"--haptic", "none"});
  EXPECT_TRUE(until([&] { return shows(); }));
  const int pause = place_.x + 590 * kWidth / 960;
  screen_->moveMouse(pause, place_.y + static_cast<int>(597.0 / 720 * kHeight));
  std::this_thread::sleep_for(300ms);
  screen_->button(1, true);
  std::this_thread::sleep_for(300ms);
  screen_->moveMouse(pause, place_.y + static_cast<int>(664.0 / 720 * kHeight));
  std::this_thread::sleep_for(300ms);
  screen_->button(1, false);
  std::this_thread::sleep_for(300ms);
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  EXPECT_EQ(report()["seeks"], json::array());
  EXPECT_EQ(report()["states"], (json{"boot", "idle", "opening", "buffering", "playing", "paused", "idle"}));
}

TEST_F(PlayerWindow, TheRightButtonPausesAlsoOverTheBar) {
  const auto player = play({"--haptic", "none", "--control", folder_ / "control"});
  ControlClient control(folder_ / "control");
  EXPECT_TRUE(until([&] { return control.ask("status")["state"] == "playing"; }));
  for (const auto& [row, state] : {std::pair{664.0, "paused"}, {597.0, "playing"}, {200.0, "paused"}}) {
    screen_->moveMouse(place_.x + 160, place_.y + static_cast<int>(row / 720 * kHeight));
    screen_->button(3, true);
    screen_->button(3, false);
    EXPECT_TRUE(until([&] { return control.ask("status")["state"] == state; })) << row;
  }
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
}

// Then the space bar pauses; on the page it would only close it.
TEST_F(PlayerWindow, TheRightButtonClosesThePageOfKeys) {
  const auto player = play({"--haptic", "none"});
  EXPECT_TRUE(until([&] { return shows(); }));
  screen_->moveMouse(place_.x + 160, place_.y + 60);
  screen_->tap("h");
  std::this_thread::sleep_for(300ms);
  screen_->button(3, true);
  screen_->button(3, false);
  std::this_thread::sleep_for(300ms);
  screen_->tap("space");
  std::this_thread::sleep_for(300ms);
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  EXPECT_EQ(report()["states"], (json{"boot", "idle", "opening", "buffering", "playing", "paused", "idle"}));
}

TEST_F(PlayerWindow, OfAFilmWithoutDepthTheWheelIsTheVolumeEverywhere) {
  makeClip(folder_ / "film.mkv", {{.pix_fmt = "yuv420p", .frames = 60, .sample = [](int component, int, int, int) {
                                     return component == 0 ? 180U : 128U;
                                   }}});
  const auto player = play({"--haptic", "pointer", "--audio", "null", "--control", folder_ / "control"});
  ControlClient control(folder_ / "control");
  EXPECT_TRUE(until([&] { return shows(); }));
  screen_->moveMouse(place_.x + 160, place_.y + 60);
  std::this_thread::sleep_for(300ms);
  screen_->button(5, true);
  screen_->button(5, false);
  EXPECT_TRUE(until([&] { return control.ask("status")["volume"] == 95; })) << control.ask("status");
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
}

// A notch of the wheel, whose event names no button, does not end the press.
TEST_F(PlayerWindow, AWheelThatTurnsDuringAClickDoesNotClickAgain) {
  const auto player = play({"--haptic", "none"});
  EXPECT_TRUE(until([&] { return shows(); }));
  const int row = place_.y + static_cast<int>(597.0 / 720 * kHeight), pause = place_.x + 590 * kWidth / 960;
  screen_->moveMouse(pause, row);
  std::this_thread::sleep_for(300ms);
  screen_->button(1, true);
  std::this_thread::sleep_for(300ms);
  screen_->button(5, true);
  screen_->button(5, false);
  screen_->moveMouse(pause + 2, row);
  std::this_thread::sleep_for(300ms);
  screen_->button(1, false);
  std::this_thread::sleep_for(300ms);
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  EXPECT_EQ(report()["states"], (json{"boot", "idle", "opening", "buffering", "playing", "paused", "idle"}));
}

// Otherwise the wheel is the finger's.
TEST_F(PlayerWindow, OverTheBarTheWheelIsTheVolumeAlsoOfAMouseThatTouches) {
  const auto player = play({"--haptic", "pointer", "--audio", "null", "--control", folder_ / "control"});
  ControlClient control(folder_ / "control");
  const auto volume = [&] { return control.ask("status")["volume"].get<double>(); };
  const auto turnAt = [&](double row) {
    screen_->moveMouse(place_.x + 160, place_.y + static_cast<int>(row / 720 * kHeight));
    std::this_thread::sleep_for(300ms);
    screen_->button(5, true);
    screen_->button(5, false);
  };
  EXPECT_TRUE(until([&] { return shows(); }));
  turnAt(664);
  EXPECT_TRUE(until([&] { return volume() == 95; })) << volume();
  turnAt(200);
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(volume(), 95);
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
}

}  // namespace
}  // namespace relievo::test
