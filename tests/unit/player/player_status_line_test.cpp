// SPDX-License-Identifier: Apache-2.0
// The line in the terminal.
#include "app/player/status_line.h"

#include <gtest/gtest.h>

namespace relievo {
namespace {

TEST(StatusText, TellsTimeSpeedDropsForceAndMissedTicks) {
  ScreenFacts facts{.title = "film.mkv", .position_s = 12.7, .duration_s = 90, .state = PlayerState::Playing};
  PlayReport report;
  report.frames_dropped = 3;
  EXPECT_EQ(statusText(facts, report, {}, "", 100), "playing 0:12 / 1:30 (14 %)  dropped 3") << "without a device";
  EXPECT_EQ(statusText(facts, report, {}, "Volume 95 %", 60), "playing 0:12 / 1:30 (14 %)  Volume 95 %  dropped 3");
  EXPECT_EQ(statusText(facts, report, {}, "Sound: \x1b[2J", 60).find('\x1b'), std::string::npos) << "of a film's words";
  report.haptic.ticks = 1000;
  report.haptic.overruns = 2;
  facts.rate = 0.5;
  facts.films = 4;
  facts.film = 2;
  EXPECT_EQ(statusText(facts, report, {1.254}, "", 100),
            "playing 0:12 / 1:30 (14 %)  0.5x  film 2 of 4  dropped 3  force 1.25 N  missed ticks 2");
  EXPECT_EQ(statusText(facts, report, {1.254}, "", 20), "playing 0:12 / 1:30") << "it does not wrap";
  EXPECT_EQ(statusText(facts, report, {1.254}, "", 60), "playing 0:12 / 1:30 (14 %)  0.5x  film 2 of 4  dropped 3")
      << "no part is cut";
  report.second_finger.emplace().haptic.overruns = 1;
  EXPECT_EQ(statusText(facts, report, {1.254, 0.5}, "", 120),
            "playing 0:12 / 1:30 (14 %)  0.5x  film 2 of 4  dropped 3  force 1.25 N, 0.50 N  missed ticks 2, 1");
  facts.position_s = 90.9;
  EXPECT_EQ(statusText(facts, report, {}, "", 30), "playing 1:30 / 1:30 (100 %)") << "the last picture of a loop";
  facts.position_s = 12.7;
  facts.duration_s = 0;
  facts.state = PlayerState::Paused;
  EXPECT_EQ(statusText(facts, report, {}, "", 12), "paused 0:12");
}

}  // namespace
}  // namespace relievo
