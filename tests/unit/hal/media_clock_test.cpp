// SPDX-License-Identifier: Apache-2.0
// The film's clock: unset until started, continuous, exact at its own rate.
#include "hal/media/media_clock.h"

#include <gtest/gtest.h>

#include <limits>

namespace relievo {
namespace {

using namespace std::chrono_literals;

// The machine's time and the film's begin far apart, so that mixing them up shows.
constexpr MonotonicTime machine(Duration d) {
  return MonotonicTime(100h + d);
}
constexpr MediaTime film(Duration d) {
  return MediaTime(d);
}

TEST(MediaClock, IsUnsetUntilStarted) {
  MediaClock clock;
  EXPECT_EQ(clock.sample(), std::nullopt) << "no pair";
  EXPECT_EQ(clock.position(machine(0s)), std::nullopt);
  EXPECT_EQ(clock.pause(machine(0s)).error().code, ErrorCode::InvalidState);
  EXPECT_EQ(clock.resume(machine(0s)).error().code, ErrorCode::InvalidState);
  EXPECT_FALSE(clock.paused());
  clock.start(film(2s), machine(0s));
  EXPECT_EQ(clock.position(machine(0s)), film(2s));
}

TEST(MediaClock, RunsNanosecondByNanosecondForDays) {
  MediaClock clock;
  clock.start(film(7ns), machine(0s));
  EXPECT_EQ(clock.position(machine(240h + 1ns)), film(240h + 8ns));
  EXPECT_EQ(clock.position(machine(-1s)), film(7ns - 1s)) << "also backwards";
}

TEST(MediaClock, StandsWhilePausedAndGoesOnFromThere) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  ASSERT_TRUE(clock.pause(machine(3s)));
  EXPECT_TRUE(clock.paused());
  EXPECT_EQ(clock.position(machine(3s)), film(3s));
  EXPECT_EQ(clock.position(machine(1h)), film(3s));
  ASSERT_TRUE(clock.resume(machine(1h)));
  EXPECT_FALSE(clock.paused());
  EXPECT_EQ(clock.position(machine(1h)), film(3s));
  EXPECT_EQ(clock.position(machine(1h + 500ms)), film(3500ms));
}

TEST(MediaClock, PausingOrResumingTwiceChangesNothing) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  ASSERT_TRUE(clock.pause(machine(1s)));
  ASSERT_TRUE(clock.pause(machine(2s)));
  EXPECT_EQ(clock.position(machine(9s)), film(1s));
  ASSERT_TRUE(clock.resume(machine(10s)));
  ASSERT_TRUE(clock.resume(machine(11s)));
  EXPECT_EQ(clock.position(machine(12s)), film(3s));
}

TEST(MediaClock, AChangeOfRateKeepsThePosition) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  ASSERT_TRUE(clock.setRate(0.5, machine(4s)));
  EXPECT_EQ(clock.position(machine(4s)), film(4s));
  EXPECT_EQ(clock.position(machine(6s)), film(5s));
  ASSERT_TRUE(clock.setRate(4.0, machine(6s)));
  EXPECT_EQ(clock.position(machine(6s)), film(5s));
  EXPECT_EQ(clock.position(machine(7s)), film(9s));
}

TEST(MediaClock, ARateSetWhilePausedHoldsFromResuming) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  ASSERT_TRUE(clock.pause(machine(1s)));
  ASSERT_TRUE(clock.setRate(2.0, machine(2s)));
  EXPECT_EQ(clock.position(machine(5s)), film(1s));
  ASSERT_TRUE(clock.resume(machine(5s)));
  EXPECT_EQ(clock.position(machine(6s)), film(3s));
}

TEST(MediaClock, ARateSetWhileUnsetHoldsFromStarting) {
  MediaClock clock;
  ASSERT_TRUE(clock.setRate(0.25, machine(0s)));
  EXPECT_EQ(clock.position(machine(0s)), std::nullopt);
  clock.start(film(0s), machine(0s));
  EXPECT_EQ(clock.position(machine(8s)), film(2s));
}

TEST(MediaClock, StaysPausedWhenStartedAgain) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  ASSERT_TRUE(clock.pause(machine(1s)));
  clock.start(film(30s), machine(2s));
  EXPECT_TRUE(clock.paused());
  EXPECT_EQ(clock.position(machine(9s)), film(30s));
}

TEST(MediaClock, ResetEndsAPauseAndKeepsTheRate) {
  MediaClock clock;
  ASSERT_TRUE(clock.setRate(2.0, machine(0s)));
  clock.start(film(0s), machine(0s));
  ASSERT_TRUE(clock.pause(machine(1s)));
  clock.reset();
  EXPECT_FALSE(clock.paused());
  EXPECT_EQ(clock.position(machine(2s)), std::nullopt);
  clock.start(film(10s), machine(3s));
  EXPECT_EQ(clock.position(machine(4s)), film(12s));
}

TEST(MediaClock, IsSteeredWithoutAJumpAndNoFurtherThanALittle) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  clock.steer(1.001, machine(10s));
  EXPECT_EQ(clock.position(machine(10s)), film(10s));
  EXPECT_LE(std::chrono::abs(*clock.position(machine(20s)) - film(20s + 10ms)), 1ns);
  clock.steer(2.0, machine(20s));
  EXPECT_DOUBLE_EQ(clock.sample()->rate, 1 + MediaClock::kMostSteering);
  clock.steer(1.0, machine(20s));
  EXPECT_LE(std::chrono::abs(*clock.position(machine(30s)) - film(30s + 10ms)), 1ns);
}

TEST(MediaClock, SteeringKeepsToThePauseAndToTheRate) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  ASSERT_TRUE(clock.pause(machine(1s)));
  clock.steer(1.004, machine(2s));
  EXPECT_EQ(clock.position(machine(9s)), film(1s));
  ASSERT_TRUE(clock.resume(machine(10s)));
  EXPECT_DOUBLE_EQ(clock.sample()->rate, 1.004);
  ASSERT_TRUE(clock.setRate(0.5, machine(10s)));
  EXPECT_DOUBLE_EQ(clock.sample()->rate, 0.502);
}

// The player sleeps until then and looks at the clock again: it must not find that it is too early.
TEST(MediaClock, WhenItSaysSoTheTimeHasCome) {
  for (const double rate : {1.0, 0.5, 0.995, 1.00001, 1.005, 1.0 / 3, 16.0}) {
    for (int i = 1; i < 1000; ++i) {
      const ClockSample sample{film(1s), machine(i * 1237ns), rate};
      const MediaTime time = film(1s + i * 40'000'019ns);
      const MediaTime reached = sample.at(sample.when(time));
      ASSERT_GE(reached, time) << rate << " " << i;
      ASSERT_LE(reached, time + 50ns) << rate << " " << i;
    }
  }
}

TEST(MediaClock, RefusesARateThatIsNone) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  for (const double rate :
       {0.0, -1.0, 16.5, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto set = clock.setRate(rate, machine(1s));
    ASSERT_FALSE(set) << rate;
    EXPECT_EQ(set.error().code, ErrorCode::InvalidArgument);
  }
  EXPECT_EQ(clock.position(machine(2s)), film(2s));
}

// A hundred changes a second at odd times: each has a rounding error under a nanosecond, and these do not add up.
TEST(MediaClock, ManyChangesDoNotAddUp) {
  MediaClock clock;
  clock.start(film(0s), machine(0s));
  Duration expected_ns{0};
  for (int i = 0; i < 1000; ++i) {
    const MonotonicTime now = machine(i * 9'999'991ns);
    ASSERT_TRUE(clock.setRate(i % 2 == 0 ? 0.5 : 1.5, now));
    expected_ns += i % 2 == 0 ? 4'999'995ns : 14'999'986ns;
  }
  const MediaTime end = *clock.position(machine(1000 * 9'999'991ns));
  EXPECT_NEAR(static_cast<double>((end - film(expected_ns)).count()), 0.0, 1000.0);
}

}  // namespace
}  // namespace relievo
