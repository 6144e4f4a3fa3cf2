// SPDX-License-Identifier: Apache-2.0
// Timestamps that jump, wrap or jump at different packets of two streams; and ones that only seem to.
#include <gtest/gtest.h>

#include <vector>

#include "hal/media/continuous_time.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

class ContinuousTimeTest : public testing::Test {
 protected:
  void SetUp() override { time_.begin(2s); }
  // The continuous time, in ms, of a packet with the container's time `ms`.
  long long place(int stream, long long ms) {
    const MediaTime own(std::chrono::milliseconds{ms});
    return (own + time_.offsetFor(stream, own)).time_since_epoch() / 1ms;
  }
  ContinuousTime time_;
};

TEST_F(ContinuousTimeTest, BelievesWhatGoesOn) {
  for (const long long ms : {0, 40, 80, 120, 1900, 3900, 3800, 3840}) EXPECT_EQ(place(0, ms), ms);
  EXPECT_EQ(place(1, 3500), 3500);  // another stream that begins a little behind
  EXPECT_EQ(time_.jumps(), 0u);
}

TEST_F(ContinuousTimeTest, AJumpForthOrBackContinuesByTheLastStep) {
  place(0, 1000);
  EXPECT_EQ(place(0, 1040), 1040);
  EXPECT_EQ(place(0, 900'000), 1080);
  EXPECT_EQ(place(0, 900'040), 1120);
  EXPECT_EQ(place(0, 5), 1160);
  EXPECT_EQ(place(0, 45), 1200);
  EXPECT_EQ(time_.jumps(), 2u);
}

// 33 bits of 90 kHz: 95443.717 s.
TEST_F(ContinuousTimeTest, ACounterThatWrapsGoesOn) {
  constexpr long long kWrap = (1LL << 33) / 90;
  long long last = place(0, kWrap - 3 * 40);
  for (long long own = kWrap - 2 * 40; own < kWrap + 10 * 40; own += 40) {
    const long long placed = place(0, own % kWrap);
    EXPECT_EQ(placed, last + 40);
    last = placed;
  }
  EXPECT_EQ(time_.jumps(), 1u);
}

// Colour reaches the seam two packets before depth does; depth keeps its distance of 10 ms on both sides.
TEST_F(ContinuousTimeTest, StreamsKeepTheirDistanceOverAJump) {
  for (long long ms = 0; ms <= 400; ms += 40) place(0, ms), place(1, ms + 10);
  EXPECT_EQ(place(0, 700'000), 440);
  EXPECT_EQ(place(0, 700'040), 480);
  EXPECT_EQ(place(1, 450), 450);  // from before the jump
  EXPECT_EQ(place(1, 490), 490);
  EXPECT_EQ(place(0, 700'080), 520);
  EXPECT_EQ(place(1, 700'090), 530);
  EXPECT_EQ(place(1, 700'130), 570);
  EXPECT_EQ(time_.jumps(), 1u);
}

// A clip of three seconds sent in a loop: the jump back is shorter than longest_gap.
TEST_F(ContinuousTimeTest, AShortJumpBackIsOneToo) {
  time_.begin(10s);
  for (long long ms = 0; ms < 3000; ms += 40) place(0, ms), place(1, ms);
  EXPECT_EQ(place(0, 0), 3000);
  EXPECT_EQ(place(1, 0), 3000);
  EXPECT_EQ(place(0, 40), 3040);
  EXPECT_EQ(place(1, 40), 3040);
  EXPECT_EQ(time_.jumps(), 1u);
}

TEST_F(ContinuousTimeTest, OneStreamThatIsMissedForLongIsNoJump) {
  for (long long ms = 0; ms <= 20'000; ms += 40) place(0, ms);
  EXPECT_EQ(place(1, 20'000), 20'000);
  for (long long ms = 20'040; ms <= 40'000; ms += 40) place(0, ms);
  EXPECT_EQ(place(1, 40'000), 40'000);
  EXPECT_EQ(time_.jumps(), 0u);
}

// Rounded decoding times may go back a little. A jump is not continued by that negative step, but by the one before it.
TEST_F(ContinuousTimeTest, AfterALittleDisorderAJumpContinuesByTheStepBeforeIt) {
  place(0, 0);
  EXPECT_EQ(place(0, 40), 40);
  EXPECT_EQ(place(0, 30), 30);
  EXPECT_EQ(place(0, 900'000), 70);
  EXPECT_EQ(time_.jumps(), 1u);
}

// The bound counts from the latest of all streams, also when another one has come last.
TEST_F(ContinuousTimeTest, AStreamThatIsBehindDoesNotMakeAGapOfTheOther) {
  place(0, 3000);
  place(0, 5000);
  EXPECT_EQ(place(1, 3200), 3200);
  EXPECT_EQ(place(0, 6900), 6900);
  EXPECT_EQ(time_.jumps(), 0u);
}

TEST_F(ContinuousTimeTest, AStreamThatBeginsFartherBehindThanTheBoundBeginsWithTheLatest) {
  place(0, 7000);
  EXPECT_EQ(place(1, 0), 7000);
  EXPECT_EQ(time_.jumps(), 1u);
}

// A part of an HLS film that is longer than the bound: all its pictures, then its sound.
TEST_F(ContinuousTimeTest, SoundThatBeginsBehindALongPartIsNoJump) {
  time_.begin(10s);
  for (long long ms = 0; ms <= 10'400; ms += 40) EXPECT_EQ(place(0, ms), ms);
  EXPECT_EQ(place(1, 50), 50);
  EXPECT_EQ(place(1, 10'390), 10'390);
  EXPECT_EQ(place(0, 10'440), 10'440);
  EXPECT_EQ(time_.jumps(), 0u);
}

TEST_F(ContinuousTimeTest, ASeekBackIsNoJumpOfAnyStream) {
  place(0, 10'000);
  place(1, 10'000);
  time_.begin(2s);
  EXPECT_EQ(place(0, 1000), 1000);
  EXPECT_EQ(place(1, 1000), 1000);
  EXPECT_EQ(time_.jumps(), 0u);
}

TEST_F(ContinuousTimeTest, WithoutABoundEveryTimeIsBelieved) {
  time_.begin(0s);
  for (const long long ms : {0, 40, 900'000, 3}) EXPECT_EQ(place(0, ms), ms);
  EXPECT_EQ(time_.jumps(), 0u);
}

TEST_F(ContinuousTimeTest, BeginsAnewAfterASeek) {
  place(0, 1000);
  EXPECT_EQ(place(0, 900'000), 1000);
  time_.begin(2s);
  EXPECT_EQ(place(0, 500'000), 500'000);
  EXPECT_EQ(time_.jumps(), 1u);
}

}  // namespace
}  // namespace relievo
