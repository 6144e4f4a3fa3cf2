// SPDX-License-Identifier: Apache-2.0
// What is wrong, as a viewer sees it in the window.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/scenario/player_window.h"
#include "tests/support/machine/control_client.h"

namespace relievo::test {
namespace {

using nlohmann::json;

// Double-clicked in a file manager: nobody reads the terminal.
TEST_F(PlayerWindow, WhyNoFilmCanBePlayedIsShownInTheListOfFilms) {
  std::ofstream(folder_ / "broken.mkv") << "no film";
  for (const char* const name : {"absent.mkv", "broken.mkv"}) {
    Process player({RELIEVO_BIN_DIR "/relievo", "--from-desktop", folder_ / name, "--films",
                    std::filesystem::path(folder_ / "x").parent_path(), "--loop", "--size", "320x240", "--report",
                    folder_ / "r.json"},
                   folder_ / "said.txt");
    window_ = screen_->find("relievo");
    ASSERT_NE(window_, 0u) << textOf("said.txt");
    place_ = screen_->place(window_).value_or(XScreen::Place{});
    screen_->focus(window_);
    const auto warns = [&](int from, int to) {  // in the colour of warnings, in these rows
      const auto pixels = screen_->pixels(place_.x, place_.y + from, kWidth, to - from);
      return std::ranges::any_of(pixels, [](const auto& pixel) { return pixel[0] > pixel[2] + 60; });
    };
    EXPECT_TRUE(until([&] { return warns(180, 225); })) << name;
    screen_->tap("End");  // behind broken.mkv
    screen_->tap("Return");
    EXPECT_TRUE(until([&] { return shows(); }));
    std::this_thread::sleep_for(500ms);
    EXPECT_FALSE(warns(0, 150)) << "it was told of another film";
    screen_->tap("q");
    EXPECT_EQ(player.wait(), 0) << textOf("said.txt");
    EXPECT_THAT(textOf("said.txt"), testing::HasSubstr(std::string(name) + ": "));
    EXPECT_EQ(report()["states"], (json{"boot", "idle", "opening", "fault", "idle", "browsing", "opening", "buffering",
                                        "playing", "idle"}));
  }
}

// A start from a menu, and one with a film, which is not opened unasked.
TEST_F(PlayerWindow, WhatIsWrongInTheSettingsIsShownInTheListOfFilms) {
  std::ofstream(folder_ / "keys.toml") << "[always]\nRIGHT = \"pase\"\n";
  std::ofstream(folder_ / "unknown.toml") << "[play]\nstereoo = \"sbs\"\n";
  std::ofstream(folder_ / "broken.toml") << "[play\n";
  const std::vector<std::vector<std::string>> starts{{"--keys", folder_ / "keys.toml"},
                                                     {"--keys", folder_ / "keys.toml", folder_ / "film.mkv"},
                                                     {"--config", folder_ / "unknown.toml"},
                                                     {"--config", folder_ / "broken.toml", folder_ / "film.mkv"}};
  for (const auto& start : starts) {
    std::vector<std::string> words{RELIEVO_BIN_DIR "/relievo",
                                   "--from-desktop",
                                   "--films",
                                   std::filesystem::path(folder_ / "x").parent_path(),
                                   "--size",
                                   "320x240",
                                   "--report",
                                   folder_ / "r.json"};
    words.insert(words.end(), start.begin(), start.end());
    Process player(words, folder_ / "said.txt");
    window_ = screen_->find("relievo");
    ASSERT_NE(window_, 0u) << textOf("said.txt");
    place_ = screen_->place(window_).value_or(XScreen::Place{});
    screen_->focus(window_);
    const auto warns = [&] {  // in the colour of warnings, near the foot
      const int top = place_.height * 3 / 4;
      const auto pixels = screen_->pixels(place_.x, place_.y + top, place_.width, place_.height - top);
      return std::ranges::any_of(pixels, [](const auto& pixel) { return pixel[0] > pixel[2] + 60; });
    };
    EXPECT_TRUE(until(warns)) << start[1];
    screen_->tap("q");
    EXPECT_EQ(player.wait(), 0) << textOf("said.txt");
    EXPECT_THAT(textOf("said.txt"), testing::HasSubstr(start[1] + ":"));
    EXPECT_EQ(report()["states"], (json{"boot", "idle", "browsing", "idle"}));
  }
}

// Before there is a window to show it in. The viewer ends that message, or a signal the program.
TEST_F(PlayerWindow, WhatEndsAProgramThatADesktopStartsIsShownOnTheDesktop) {
  for (const bool killed : {false, true}) {
    Process player(
        {RELIEVO_BIN_DIR "/relievo", "--from-desktop", folder_ / "film.mkv", "--report", "/proc/none/r.json"},
        folder_ / "said.txt");
    const auto box = screen_->find("relievo");
    ASSERT_NE(box, 0u) << textOf("said.txt");
    EXPECT_TRUE(player.isRunning());
    if (killed) {
      player.send(SIGTERM);
      EXPECT_EQ(player.wait(), -SIGTERM);
      EXPECT_TRUE(until([&] { return !screen_->place(box); })) << "the message goes with its program";
      continue;
    }
    screen_->focus(box);
    screen_->tap("Return");
    EXPECT_EQ(player.wait(), 1);
    EXPECT_THAT(textOf("said.txt"), testing::HasSubstr("/proc/none/r.json: "));
  }
}

// Once; its depth is a level.
TEST_F(PlayerWindow, WhyTheDepthLooksWrongIsShownOverTheFilm) {
  makeClip(folder_ / "film.mkv",
           {{.pix_fmt = "yuv420p", .frames = 60, .sample = [](int c, int, int, int) { return c == 0 ? 180U : 128U; }},
            {.pix_fmt = "gray", .frames = 60, .sample = [](int, int, int, int) { return 128U; }}});
  const auto player = play({"--haptic", "none"});
  const auto warns = [&] {
    const auto pixels = screen_->pixels(place_.x, place_.y + 30, kWidth, 50);
    return std::ranges::any_of(pixels, [](const auto& pixel) { return pixel[0] > pixel[2] + 60; });
  };
  EXPECT_TRUE(until(warns));
  EXPECT_TRUE(until([&] { return shows() && !warns(); })) << "it goes, and does not come with each loop";
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  EXPECT_THAT(textOf("said.txt"), testing::HasSubstr("of the depth is one code"));
}

// The next film is an ordinary one: nobody has said which end of its depth is near.
TEST_F(PlayerWindow, ADoubtGoesWithItsFilm) {
  const auto even = [](int c, int, int, int) { return c == 0 ? 180U : 128U; };
  const auto level = [](int, int, int, int) { return 128U; };
  const auto floor = [](int, int, int r, int) { return 60U + 2U * static_cast<unsigned>(r); };
  makeClip(folder_ / "film.mkv", {{.pix_fmt = "yuv420p", .frames = 600, .sample = even},
                                  {.pix_fmt = "gray", .frames = 600, .sample = level}});
  makeClip(folder_ / "next.mkv", {{.pix_fmt = "yuv420p", .frames = 600, .sample = even},
                                  {.pix_fmt = "gray", .frames = 600, .sample = floor}});
  const auto player = play({folder_ / "next.mkv", "--haptic", "none", "--control", folder_ / "control"});
  ControlClient control(folder_ / "control");
  const auto warns = [&] {
    const auto pixels = screen_->pixels(place_.x, place_.y + 30, kWidth, 50);
    return std::ranges::any_of(pixels, [](const auto& pixel) { return pixel[0] > pixel[2] + 60; });
  };
  EXPECT_TRUE(until(warns));
  screen_->tap("n");
  EXPECT_NE(screen_->find("next.mkv - relievo"), 0u);
  EXPECT_TRUE(until([&] { return shows() && !warns(); }));
  if (control.ask("status")["position_s"] > 6) GTEST_SKIP() << "too slow to tell: a warning stands for 8 s of the film";
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  const std::string said = textOf("said.txt");
  EXPECT_NE(said.find("of the depth is one code"), std::string::npos) << said;
  EXPECT_NE(said.find("nothing says which end of the depth is near"), std::string::npos) << said;
}

}  // namespace
}  // namespace relievo::test
