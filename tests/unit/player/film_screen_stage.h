// SPDX-License-Identifier: Apache-2.0
// The player's screen on a display that shows nothing, in simulated time.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "app/player/screen/film_screen.h"
#include "drivers/mock/mock.h"
#include "platform/log.h"

namespace relievo::test {

inline constexpr auto kMs = std::chrono::milliseconds(1);

class FilmScreenStage : public testing::Test {
 protected:
  FilmScreenStage() { setLogLevel(LogLevel::Error); }
  void make() {
    screen_.reset();  // before its display
    profile_.refresh_period = Duration(0);
    profile_.shown = [this] {
      ++presented_;
      clock_.sleepUntil(clock_.now() + drawing_);
    };
    display_ = makeMockDisplay(profile_, clock_, cable_);
    screen_.emplace(*display_, config_, stereo_, osd_, clock_, journal_, files_);
    ASSERT_TRUE(screen_->open(stop_));
  }
  bool show() { return screen_->show({}, {}, {}, {}, {}, clock_.now()).value_or(false); }
  // How many pictures are presented when it is asked to draw again, `later` than before.
  int redraw(const std::optional<FingerMark>& finger, Duration later, MonotonicTime next = MonotonicTime::max()) {
    clock_.sleepUntil(clock_.now() + later);
    const int before = presented_;
    EXPECT_TRUE(screen_->redraw({finger}, {}, next, clock_.now()));
    return presented_ - before;
  }
  [[nodiscard]] PlayReport report() const {
    PlayReport report;
    screen_->describe(report);
    return report;
  }
  [[nodiscard]] bool noted(const std::string& part) const {
    for (const FaultEntry& fault : journal_.written().faults) {
      if (fault.what.find(part) != std::string::npos) return true;
    }
    return false;
  }

  ManualClock clock_;
  std::atomic<bool> stop_{false};
  Journal journal_{clock_};
  FileWriter files_{FileWriter::Where::AtOnce};
  MockDisplayProfile profile_;
  DisplayConfig config_;
  StereoSettings stereo_;
  std::shared_ptr<MockDisplayBench> cable_ = std::make_shared<MockDisplayBench>();
  std::unique_ptr<Display> display_;
  std::optional<FilmScreen> screen_;
  int presented_ = 0;
  bool osd_ = true;
  Duration drawing_{0};  // of each picture
};

}  // namespace relievo::test
