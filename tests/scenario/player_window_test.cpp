// SPDX-License-Identifier: Apache-2.0
// The program in a window on an X server of the test's own: its viewer has a keyboard, a mouse and a close button.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/control_client.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/x_screen.h"

namespace relievo {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

class PlayerWindow : public testing::Test {
 protected:
  static constexpr int kWidth = 320, kHeight = 240;

  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << test::kNoXServer;
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    // A gray picture; its depth is that of a wall in the middle.
    test::makeClip(folder_ / "film.mkv",
                   {{.pix_fmt = "yuv420p",
                     .frames = 60,
                     .sample = [](int component, int, int, int) { return component == 0 ? 180U : 128U; },
                     .tags = {{"title", "color"}}},
                    {.pix_fmt = "gray",
                     .frames = 60,
                     .sample = [](int, int, int, int) { return 128U; },
                     .tags = {{"title", "depth"}}}});
  }
  std::unique_ptr<test::Process> play(std::vector<std::string> words) {
    words.insert(words.begin(),
                 {std::string(RELIEVO_BIN_DIR) + "/relievo", "play", folder_ / "film.mkv", "--loop", "--display",
                  "window", "--size", "320x240", "--stereo", "mono", "--report", folder_ / "r.json"});
    auto player = std::make_unique<test::Process>(words, folder_ / "said.txt");
    window_ = screen_->find("film.mkv - relievo");
    EXPECT_NE(window_, 0u) << textOf("said.txt");
    place_ = screen_->place(window_).value_or(test::XScreen::Place{});
    screen_->focus(window_);
    return player;
  }
  static bool until(const std::function<bool()>& so) {
    for (int tries = 0; tries < 4000; ++tries) {
      if (so()) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }
  // The film's gray, in the middle of the window.
  [[nodiscard]] bool shows() const {
    const auto [red, green, blue] = screen_->pixel(place_.x + 40, place_.y + kHeight / 2);
    return red > 100 && red == green && green == blue;
  }
  [[nodiscard]] std::string textOf(const std::string& name) const {
    const std::ifstream file(folder_ / name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  [[nodiscard]] json report() const { return json::parse(textOf("r.json"), nullptr, false); }

  test::TemporaryFolder folder_;
  std::unique_ptr<test::XScreen> screen_ = test::XScreen::start();
  unsigned long window_ = 0;
  test::XScreen::Place place_;
};

TEST_F(PlayerWindow, ShowsTheFilmAndItsKeysAreTheRemote) {
  const auto player = play({"--haptic", "none"});
  EXPECT_TRUE(until([&] { return shows(); }));
  for (const char* key : {"space", "Tab", "space", "Escape", "q"}) {
    screen_->tap(key);
    std::this_thread::sleep_for(50ms);  // the same key twice within 2 ms is taken for its repeat
  }
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  const json r = report();
  EXPECT_EQ(r["states"], (json{"boot", "idle", "opening", "buffering", "playing", "paused", "playing", "idle"}));
  EXPECT_EQ(r["video"]["display"], "window");
  EXPECT_EQ(r["video"]["stereo"], "sbs") << "the next one after mono";
  EXPECT_EQ(r["video"]["surface"], (json{kWidth, kHeight}));
}

// No option: what a desktop's viewer types first.
TEST_F(PlayerWindow, AFileAloneOpensAWindowOfItsSizeAndTheMouseIsTheFinger) {
  test::ClipTrack color{.pix_fmt = "yuv420p", .width = 400, .height = 240, .frames = 60, .tags = {{"title", "color"}}};
  color.sample = [](int component, int, int, int) { return component == 0 ? 180U : 128U; };
  test::ClipTrack depth{.pix_fmt = "gray", .width = 400, .height = 240, .frames = 60, .tags = {{"title", "depth"}}};
  depth.sample = [](int, int, int, int) { return 128U; };
  test::makeClip(folder_ / "wide film.mkv", {color, depth});
  test::Process player(
      {RELIEVO_BIN_DIR "/relievo", folder_ / "wide film.mkv", "--loop", "--report", folder_ / "r.json"},
      folder_ / "said.txt");
  window_ = screen_->find("wide film.mkv - relievo");
  ASSERT_NE(window_, 0u) << textOf("said.txt");
  place_ = screen_->place(window_).value_or(test::XScreen::Place{});
  EXPECT_EQ(place_.width, 400);
  EXPECT_EQ(place_.height, 240);
  EXPECT_TRUE(until([&] { return shows(); }));
  screen_->focus(window_);
  screen_->moveMouse(place_.x + 300, place_.y + 60);
  screen_->button(1, true);
  std::this_thread::sleep_for(1500ms);
  screen_->button(1, false);
  screen_->tap("q");
  EXPECT_EQ(player.wait(), 0) << textOf("said.txt");
  const json r = report();
  EXPECT_EQ(r["video"]["display"], "window");
  EXPECT_EQ(r["video"]["stereo"], "mono");
  EXPECT_EQ(r["haptic"]["device"], "pointer");
  EXPECT_GT(r["force"]["max_n"].get<double>(), 0.5);
  EXPECT_EQ(textOf("said.txt").find("unit="), std::string::npos) << "a developer's line: " << textOf("said.txt");
  EXPECT_THAT(textOf("said.txt"), testing::HasSubstr("near bright"));
}

// Without a film: the list, its poster, a click on its row, and back. The view is 960 units wide and 720 high.
TEST_F(PlayerWindow, WithoutAFilmItShowsTheListAndAClickPlaysOne) {
  test::Process player(
      {RELIEVO_BIN_DIR "/relievo", "--films", std::filesystem::path(folder_ / "x").parent_path(), "--display", "window",
       "--size", "640x480", "--haptic", "pointer", "--report", folder_ / "r.json"},
      folder_ / "said.txt");
  window_ = screen_->find("relievo");
  ASSERT_NE(window_, 0u) << textOf("said.txt");
  place_ = screen_->place(window_).value_or(test::XScreen::Place{});
  screen_->focus(window_);
  const auto poster = [&] { return screen_->pixel(place_.x + 80, place_.y + 112)[0] > 100; };
  EXPECT_TRUE(until(poster)) << "the film's gray";
  EXPECT_LT(screen_->pixel(place_.x + 320, place_.y + 300)[0], 60) << "below the only row";
  const auto clickAt = [&](int x, int y) {
    screen_->moveMouse(place_.x + x, place_.y + y);
    screen_->button(1, true), screen_->button(1, false);
  };
  const auto ground = [&] { return screen_->pixel(place_.x + 2, place_.y + 2)[2]; };  // a dark slate; darker with keys
  const int list = ground();
  clickAt(590, 464);  // "h: all keys"
  EXPECT_TRUE(until([&] { return ground() < list; })) << "the page of keys";
  clickAt(590, 464);
  EXPECT_TRUE(until([&] { return ground() == list; }));
  clickAt(320, 116);
  EXPECT_TRUE(until([&] { return screen_->pixel(place_.x + 320, place_.y + 300)[0] > 100; })) << "the film";
  std::this_thread::sleep_for(300ms);
  screen_->tap("Escape");
  EXPECT_TRUE(until([&] { return screen_->pixel(place_.x + 320, place_.y + 300)[0] < 60 && poster(); }));
  ASSERT_TRUE(screen_->drop(window_, folder_ / "film.mkv"));
  EXPECT_TRUE(until([&] { return screen_->pixel(place_.x + 320, place_.y + 300)[0] > 100; })) << "dropped on the list";
  screen_->tap("q");
  EXPECT_EQ(player.wait(), 0) << textOf("said.txt");
  EXPECT_EQ(report()["states"], (json{"boot", "idle", "browsing", "opening", "buffering", "playing", "idle", "browsing",
                                      "opening", "buffering", "playing", "idle"}));
}

// There is no window manager here: SDL's wish alone changes nothing.
TEST_F(PlayerWindow, FFillsTheScreenAndEscapeLeavesItButNotTheFilm) {
  const auto player = play({"--haptic", "none"});
  EXPECT_TRUE(until([&] { return shows(); }));
  const auto width = [&] { return screen_->place(window_).value_or(test::XScreen::Place{}).width; };
  for (const auto& [key, fills] : {std::pair{"f", true}, {"Escape", false}, {"F11", true}, {"f", false}}) {
    screen_->tap(key);
    EXPECT_TRUE(until([&] { return width() == (fills ? test::XScreen::kWidth : kWidth); })) << key << " " << width();
    EXPECT_TRUE(until([&] {
      const auto [red, green, blue] = screen_->pixel(test::XScreen::kWidth - 20, test::XScreen::kHeight - 150);
      return fills == (red > 100 && red == green && green == blue);
    })) << key
        << ": the picture reaches the screen's edge";
    screen_->focus(window_);
  }
  screen_->tap("Escape");
  std::this_thread::sleep_for(300ms);
  EXPECT_TRUE(player->isRunning());
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
}

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

TEST_F(PlayerWindow, ItsCloseButtonEndsThePausedFilmWhateverTheRemoteIs) {
  std::ofstream(folder_ / "keys.txt") << "0.5 PAUSE\n0.9 PAUSE\n";  // the first may come too early
  const auto player = play({"--haptic", "none", "--remote", "script:" + folder_ / "keys.txt"});
  EXPECT_TRUE(until([&] { return shows(); }));
  screen_->tap("q");  // a key of the window, not of the remote
  std::this_thread::sleep_for(1s);
  EXPECT_TRUE(player->isRunning());
  screen_->askToClose(window_);
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  const json r = report();
  ASSERT_GE(r["states"].size(), 2u);
  EXPECT_EQ(r["states"][r["states"].size() - 2], "paused") << r["states"];
  EXPECT_TRUE(r["faults"].empty()) << r["faults"];
}

// While a film is paused, no new picture comes: a larger window must be filled by drawing the present one again.
TEST_F(PlayerWindow, ThePausedPictureFollowsTheWindow) {
  const auto player = play({"--haptic", "none"});
  EXPECT_TRUE(until([&] { return shows(); }));
  screen_->tap("space");
  screen_->resize(window_, 480, 360);
  EXPECT_TRUE(until([&] {
    const auto [red, green, blue] = screen_->pixel(place_.x + 440, place_.y + 200);
    return red > 100 && red == green && green == blue;
  })) << "where there was no window before";
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << textOf("said.txt");
  EXPECT_EQ(report()["video"]["surface"], (json{480, 360}));
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

// Otherwise the wheel is the finger's.
TEST_F(PlayerWindow, OverTheBarTheWheelIsTheVolumeAlsoOfAMouseThatTouches) {
  const auto player = play({"--haptic", "pointer", "--audio", "null", "--control", folder_ / "control"});
  test::ControlClient control(folder_ / "control");
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

TEST_F(PlayerWindow, WithoutADesktopItSaysSoInOneLine) {
  ::unsetenv("DISPLAY");
  test::Process player({std::string(RELIEVO_BIN_DIR) + "/relievo", "play", folder_ / "film.mkv", "--display", "window"},
                       folder_ / "said.txt");
  EXPECT_EQ(player.wait(), 1);
  EXPECT_THAT(textOf("said.txt"), testing::StartsWith("relievo: display window: there is no desktop"));
}

// A session that ends under the program. Mesa's software driver can then repeat the transfer of a picture on the broken
// connection, for minutes.
TEST_F(PlayerWindow, AServerThatDiesDoesNotLeaveItHanging) {
  for (const bool answered : {true, false}) {
    if (screen_ == nullptr) screen_ = test::XScreen::start();
    const auto player = play({"--haptic", "sim"});
    EXPECT_TRUE(until([&] { return shows(); }));
    screen_->kill(answered);
    screen_.reset();
    ASSERT_TRUE(until([&] { return !player->isRunning(); })) << answered;
    EXPECT_EQ(player->wait(), 1) << textOf("said.txt");
    EXPECT_THAT(textOf("said.txt"), testing::HasSubstr("window: the X server has ended"));
  }
}

}  // namespace
}  // namespace relievo
