// SPDX-License-Identifier: Apache-2.0
// How the programs report progress, on a terminal and elsewhere, in simulated time.
#include <gtest/gtest.h>

#include "app/cli/progress_line.h"
#include "platform/clock.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

std::string saidBy(const std::function<void()>& work) {
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

TEST(ProgressLine, WithoutATerminalIsALineEveryTenSeconds) {
  ManualClock clock;
  setLogProgram("worker");
  const std::string said = saidBy([&] {
    ProgressLine line(clock, false);
    for (int i = 0; i < 250; ++i, clock.advance(100ms)) line.say("film " + std::to_string(i));
  });
  EXPECT_EQ(said, "worker: progress: film 100\nworker: progress: film 200\n");
}

TEST(ProgressLine, WithoutATerminalAShortJobSaysNothing) {
  ManualClock clock;
  EXPECT_EQ(saidBy([&] {
              ProgressLine line(clock, false);
              for (int i = 0; i < 99; ++i, clock.advance(100ms)) line.show([](Duration) { return std::string("x"); });
            }),
            "");
}

TEST(ProgressLine, OnATerminalIsWrittenOverAndGoneAtTheEnd) {
  ManualClock clock;
  EXPECT_EQ(saidBy([&] {
              ProgressLine line(clock, true);
              line.show([](Duration) { return std::string("first"); });
              clock.advance(100ms);
              line.show([](Duration) { return std::string("too soon"); });
              line.say("a step");
              clock.advance(200ms);
              line.show([](Duration at) { return std::to_string(at.count()); });
            }),
            "\r\033[Kfirst\r\033[Ka step\r\033[K300000000\r\033[K");
}

// As of a film of two views: surveyed, then matched.
TEST(ProgressLine, CountsTheTimeOfEachPassByItself) {
  ManualClock clock;
  ProgressLine line(clock, true);
  for (const std::uint64_t done : {1, 2, 3, 1, 2}) {
    clock.advance(1s);
    line.count(done);
  }
  EXPECT_EQ(line.elapsed(), 2s);
}

}  // namespace
}  // namespace relievo
