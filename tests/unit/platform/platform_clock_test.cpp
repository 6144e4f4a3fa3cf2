// SPDX-License-Identifier: Apache-2.0
// The clock that a test sets, and properties of the real one that hold on any machine, however slow.
#include "platform/clock.h"

#include <gtest/gtest.h>
#include <sys/time.h>

#include <csignal>

namespace relievo {
namespace {

using std::chrono::milliseconds;

MonotonicTime at(Duration since_start) {
  return MonotonicTime{} + since_start;
}

TEST(Duration, ConvertsSecondsToTheNearestNanosecond) {
  EXPECT_EQ(fromSeconds(1.5), milliseconds(1500));
  EXPECT_EQ(fromSeconds(-1.5), milliseconds(-1500));
  EXPECT_EQ(fromSeconds(1.0e-9 * 2.6), Duration(3));
  EXPECT_EQ(fromSeconds(-1.0e-9 * 2.6), Duration(-3));
  EXPECT_DOUBLE_EQ(toSeconds(milliseconds(1500)), 1.5);
}

TEST(ManualClock, StandsStillUntilTold) {
  const ManualClock clock(at(milliseconds(7)));
  EXPECT_EQ(clock.now(), at(milliseconds(7)));
  EXPECT_EQ(clock.now(), at(milliseconds(7)));
}

TEST(ManualClock, AdvancesByWhatItIsTold) {
  ManualClock clock;
  clock.advance(milliseconds(3));
  clock.advance(Duration(5));
  EXPECT_EQ(clock.now(), at(Duration(3'000'005)));
}

TEST(ManualClock, SleepsByMovingToTheDeadline) {
  ManualClock clock;
  clock.sleepUntil(at(milliseconds(10)));
  EXPECT_EQ(clock.now(), at(milliseconds(10)));
}

TEST(ManualClock, NeverSleepsBackwards) {
  ManualClock clock(at(milliseconds(10)));
  clock.sleepUntil(at(milliseconds(4)));
  EXPECT_EQ(clock.now(), at(milliseconds(10)));
}

TEST(MonotonicClock, NeverGoesBack) {
  const MonotonicClock clock;
  MonotonicTime last = clock.now();
  EXPECT_GT(last, MonotonicTime{});
  for (int i = 0; i < 10'000; ++i) {
    const MonotonicTime now = clock.now();
    ASSERT_GE(now, last);
    last = now;
  }
}

// Not before the deadline either when signals come in between.
TEST(MonotonicClock, SleepsUntilTheDeadlineThroughSignals) {
  struct sigaction heard{}, before{};
  heard.sa_handler = [](int) {};
  ASSERT_EQ(::sigaction(SIGALRM, &heard, &before), 0);
  const itimerval often{.it_interval = {0, 500}, .it_value = {0, 500}};
  ASSERT_EQ(::setitimer(ITIMER_REAL, &often, nullptr), 0);
  MonotonicClock clock;
  const MonotonicTime deadline = clock.now() + milliseconds(5);
  clock.sleepUntil(deadline);
  EXPECT_GE(clock.now(), deadline);
  const itimerval never{};
  ::setitimer(ITIMER_REAL, &never, nullptr);
  ::sigaction(SIGALRM, &before, nullptr);
}

// A deadline that is waited for although it has passed leaves the test hanging, until CTest's limit ends it.
TEST(MonotonicClock, ReturnsFromDeadlinesThatHavePassed) {
  MonotonicClock clock;
  clock.sleepUntil(MonotonicTime{});
  clock.sleepUntil(at(Duration(-1)));
  clock.sleepUntil(MonotonicTime::min());
  clock.sleepUntil(clock.now());
}

}  // namespace
}  // namespace relievo
