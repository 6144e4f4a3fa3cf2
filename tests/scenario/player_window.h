// SPDX-License-Identifier: Apache-2.0
// The player's program in a window on an X server of the test's own: its viewer has a keyboard, a mouse and a close
// button.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/x_screen.h"

namespace relievo::test {

using namespace std::chrono_literals;

class PlayerWindow : public testing::Test {
 protected:
  static constexpr int kWidth = 320, kHeight = 240;

  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << kNoXServer;
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    // A gray picture; its depth is that of a wall in the middle, beside a lower strip: one code alone looks wrong.
    makeClip(folder_ / "film.mkv",
             {{.pix_fmt = "yuv420p",
               .frames = 60,
               .sample = [](int component, int, int, int) { return component == 0 ? 180U : 128U; },
               .tags = {{"title", "color"}}},
              {.pix_fmt = "gray",
               .frames = 60,
               .sample = [](int, int column, int, int) { return column < 4 ? 64U : 128U; },
               .tags = {{"title", "depth"}, {"DEPTH_POLARITY", "near-high"}}}});
  }
  std::unique_ptr<Process> play(std::vector<std::string> words) {
    words.insert(words.begin(),
                 {std::string(RELIEVO_BIN_DIR) + "/relievo", "play", folder_ / "film.mkv", "--loop", "--display",
                  "window", "--size", "320x240", "--stereo", "mono", "--report", folder_ / "r.json"});
    auto player = std::make_unique<Process>(words, folder_ / "said.txt");
    window_ = screen_->find("film.mkv - relievo");
    EXPECT_NE(window_, 0u) << textOf("said.txt");
    place_ = screen_->place(window_).value_or(XScreen::Place{});
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
  [[nodiscard]] nlohmann::json report() const { return nlohmann::json::parse(textOf("r.json"), nullptr, false); }

  TemporaryFolder folder_;
  std::unique_ptr<XScreen> screen_ = XScreen::start();
  unsigned long window_ = 0;
  XScreen::Place place_;
};

}  // namespace relievo::test
