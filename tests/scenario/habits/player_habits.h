// SPDX-License-Identifier: Apache-2.0
// The player's program in a window, with a film of tracks, chapters and subtitles, and a quiet one before it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/scenario/habits/habit_films.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/control_client.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/until.h"
#include "tests/support/machine/x_screen.h"

namespace relievo::test {

using namespace std::chrono_literals;
using nlohmann::json;

class PlayerHabits : public testing::Test {
 protected:
  static constexpr int kWidth = 320, kHeight = 240;
  static constexpr double kRow = kHeight / 720.0;  // of the display over the picture

  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << kNoXServer;
    ::setenv("XDG_PICTURES_DIR", (folder_ / "").c_str(), 1);
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    ::setenv("ALSA_CONFIG_PATH", (folder_ / "asound.conf").c_str(), 1);
    std::ofstream(folder_ / "asound.conf") << "pcm.hear { type file slave.pcm nowhere file \"" << folder_ / "sound.raw"
                                           << "\" format raw }\npcm.nowhere { type null }\n";
    std::ofstream(folder_ / "keys.toml") << "[always]\nK = \"depth -0.1\"\n";
    makeFilm(folder_ / "quiet.mkv", 20);
    makeFilm(folder_ / "dropped.mkv", 20);
    makeFilmOfTracks(folder_);
  }
  void play() {
    player_ = std::make_unique<Process>(
        std::vector<std::string>{RELIEVO_BIN_DIR "/relievo", folder_ / "quiet.mkv", folder_ / "film.mkv", "--size",
                                 "320x240", "--haptic", "none", "--audio", "alsa:hear", "--keys", folder_ / "keys.toml",
                                 "--volume", "100", "--control", folder_ / "control"},
        folder_ / "said.txt");
    control_ = std::make_unique<ControlClient>(folder_ / "control");
    show("quiet.mkv - relievo");
  }
  void show(const std::string& title) {
    window_ = screen_->find(title);
    ASSERT_NE(window_, 0u) << title << "\n" << said();
    place_ = screen_->place(window_).value_or(XScreen::Place{});
    screen_->focus(window_);
  }
  [[nodiscard]] std::string said() const {
    const std::ifstream file(folder_ / "said.txt");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  [[nodiscard]] json status() { return control_->ask("status"); }
  // A key, "Shift_L+slash", and what the player then says of itself.
  void press(const std::string& keys) const {
    const std::size_t plus = keys.find('+');
    if (plus == std::string::npos) screen_->tap(keys.c_str());
    else screen_->tapWith(keys.substr(0, plus).c_str(), keys.substr(plus + 1).c_str());
  }
  void click(unsigned button) const { screen_->button(button, true), screen_->button(button, false); }
  void expectAfter(const std::string& keys, const char* what, const json& value) {
    press(keys);
    json last;
    const auto is = [&] {
      last = status()[what];
      if (value.is_number() && last.is_number()) return std::abs(last.get<double>() - value.get<double>()) < 0.25e-1;
      return last == value;
    };
    EXPECT_TRUE(until(is)) << keys << ": " << what << " is " << last << " instead of " << value;
  }
  void expectPlace(const std::string& keys, double seconds) {
    press(keys);
    double last = 0;
    const auto is = [&] {
      const json now = status();
      last = now["position_s"].get<double>();
      return now["state"] == "paused" && std::abs(last - seconds) < 0.21;
    };
    EXPECT_TRUE(until(is)) << keys << ": at " << last << " s instead of " << seconds;
  }
  using Color = std::array<int, 3>;
  [[nodiscard]] Color at(int x, int y) const { return screen_->pixel(place_.x + x, place_.y + y); }
  static bool isAccent(const Color& color) { return color[0] > color[2] + 50; }
  static bool isFilm(const Color& color) { return color[0] > 100 && color[0] == color[1] && color[1] == color[2]; }
  // A white pixel of subtitles: between these rows of the window.
  [[nodiscard]] bool hasWords(int from, int to) const {
    const auto pixels = screen_->pixels(place_.x + kWidth / 4, place_.y + from, kWidth / 2, to - from);
    return std::ranges::any_of(pixels, [](const Color& color) { return color[0] > 235; });
  }

  TemporaryFolder folder_;
  std::unique_ptr<XScreen> screen_ = XScreen::start();
  std::unique_ptr<Process> player_;
  std::unique_ptr<ControlClient> control_;
  unsigned long window_ = 0;
  XScreen::Place place_;

  void aQuietFilmLeavesTheSoundCardToOthers();
  void theNextFilmHasSound();
  void pauseStepAndSeek();
  void chapters();
  void soundAndVolume();
  void subtitles();
  void picture();
  void pages();
  void mouseOnThePage();
  void speedAndLoop();
  void aFileIsDropped();
};

}  // namespace relievo::test
