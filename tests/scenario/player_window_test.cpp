// SPDX-License-Identifier: Apache-2.0
// What a viewer sees of the window, and does with keys and files.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "tests/scenario/player_window.h"
#include "tests/support/machine/control_client.h"

namespace relievo::test {
namespace {

using nlohmann::json;

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
  ClipTrack color{.pix_fmt = "yuv420p", .width = 400, .height = 240, .frames = 60, .tags = {{"title", "color"}}};
  color.sample = [](int component, int, int, int) { return component == 0 ? 180U : 128U; };
  ClipTrack depth{.pix_fmt = "gray", .width = 400, .height = 240, .frames = 60, .tags = {{"title", "depth"}}};
  depth.sample = [](int, int, int, int) { return 128U; };
  makeClip(folder_ / "wide film.mkv", {color, depth});
  Process player({RELIEVO_BIN_DIR "/relievo", folder_ / "wide film.mkv", "--loop", "--report", folder_ / "r.json"},
                 folder_ / "said.txt");
  window_ = screen_->find("wide film.mkv - relievo");
  ASSERT_NE(window_, 0u) << textOf("said.txt");
  place_ = screen_->place(window_).value_or(XScreen::Place{});
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
  Process player({RELIEVO_BIN_DIR "/relievo", "--films", std::filesystem::path(folder_ / "x").parent_path(),
                  "--display", "window", "--size", "640x480", "--haptic", "pointer", "--report", folder_ / "r.json"},
                 folder_ / "said.txt");
  window_ = screen_->find("relievo");
  ASSERT_NE(window_, 0u) << textOf("said.txt");
  place_ = screen_->place(window_).value_or(XScreen::Place{});
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
  screen_->moveMouse(place_.x + 320, place_.y + 116);
  screen_->button(3, true), screen_->button(3, false);
  std::this_thread::sleep_for(500ms);  // states: it plays nothing
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

TEST_F(PlayerWindow, SubtitlesThatAreDroppedAreShownWithTheFilm) {
  std::ofstream(folder_ / "words.SRT") << "1\n00:00:00,000 --> 00:00:09,000\nHELLO HELLO\n";
  std::ofstream(folder_ / "broken.srt") << "no words";
  const auto player = play({"--haptic", "none", "--control", folder_ / "control"});
  ControlClient control(folder_ / "control");
  EXPECT_TRUE(until([&] { return shows(); }));
  const auto words = [&] {  // white on gray, within the lower third
    const auto pixels = screen_->pixels(place_.x, place_.y + 160, kWidth, 80);
    return std::ranges::count_if(pixels, [](const auto& pixel) { return pixel[2] > 240; });
  };
  EXPECT_TRUE(until([&] { return words() == 0; })) << "the bar goes";
  ASSERT_TRUE(screen_->drop(window_, folder_ / "words.SRT"));
  EXPECT_TRUE(until([&] { return words() > 30; })) << words();
  EXPECT_EQ(control.ask("status")["subtitles"], "1 of 1, words.SRT");
  ASSERT_TRUE(screen_->drop(window_, folder_ / "broken.srt"));
  const auto said = [&] { return textOf("said.txt"); };
  EXPECT_TRUE(until([&] { return said().find("subtitles 2 of 2, broken.srt: ") != std::string::npos; })) << said();
  EXPECT_TRUE(until([&] { return control.ask("status")["subtitles"] == "off"; })) << "it is not chosen any more";
  screen_->tap("q");
  EXPECT_EQ(player->wait(), 0) << said();
  const json states = report()["states"];
  EXPECT_EQ(std::ranges::count(states, "opening"), 1) << states << ": they are not played as films";
}

// There is no window manager here: SDL's wish alone changes nothing.
TEST_F(PlayerWindow, FFillsTheScreenAndEscapeLeavesItButNotTheFilm) {
  const auto player = play({"--haptic", "none"});
  EXPECT_TRUE(until([&] { return shows(); }));
  const auto width = [&] { return screen_->place(window_).value_or(XScreen::Place{}).width; };
  for (const auto& [key, fills] : {std::pair{"f", true}, {"Escape", false}, {"F11", true}, {"f", false}}) {
    screen_->tap(key);
    EXPECT_TRUE(until([&] { return width() == (fills ? XScreen::kWidth : kWidth); })) << key << " " << width();
    EXPECT_TRUE(until([&] {
      const auto [red, green, blue] = screen_->pixel(XScreen::kWidth - 20, XScreen::kHeight - 150);
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

// A window of the film's size is hidden until there is a picture.
TEST_F(PlayerWindow, FsFillsTheScreenFromTheBeginningWithAFilmAndInTheListOfFilms) {
  const std::string films = std::filesystem::path(folder_ / "x").parent_path();
  for (const auto& [words, title, before] :
       {std::tuple(std::vector<std::string>{folder_ / "film.mkv", "--loop"}, "film.mkv - relievo", 64),
        {{"--films", films, "--size", "320x240"}, "relievo", kWidth}}) {
    std::vector<std::string> all{RELIEVO_BIN_DIR "/relievo", "--fs"};
    all.insert(all.end(), words.begin(), words.end());
    Process player(all, folder_ / "said.txt");
    window_ = screen_->find(title);
    ASSERT_NE(window_, 0u) << textOf("said.txt");
    const auto width = [&] { return screen_->place(window_).value_or(XScreen::Place{}).width; };
    EXPECT_TRUE(until([&] { return width() == XScreen::kWidth; })) << width();
    std::this_thread::sleep_for(1s);
    EXPECT_EQ(width(), XScreen::kWidth) << "it stays so";
    screen_->focus(window_);
    screen_->tap("f");
    EXPECT_TRUE(until([&] { return width() == before; })) << width();
    screen_->focus(window_);
    screen_->tap("q");
    EXPECT_EQ(player.wait(), 0) << textOf("said.txt");
  }
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

TEST_F(PlayerWindow, WithoutADesktopItSaysSoInOneLine) {
  ::unsetenv("DISPLAY");
  Process player({std::string(RELIEVO_BIN_DIR) + "/relievo", "play", folder_ / "film.mkv", "--display", "window"},
                 folder_ / "said.txt");
  EXPECT_EQ(player.wait(), 1);
  EXPECT_THAT(textOf("said.txt"), testing::StartsWith("relievo: display window: there is no desktop"));
}

// A session that ends under the program. Mesa's software driver can then repeat the transfer of a picture on the broken
// connection, for minutes.
TEST_F(PlayerWindow, AServerThatDiesDoesNotLeaveItHanging) {
  for (const bool answered : {true, false}) {
    if (screen_ == nullptr) screen_ = XScreen::start();
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
}  // namespace relievo::test
