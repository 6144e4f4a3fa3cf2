// SPDX-License-Identifier: Apache-2.0
// Pairing by time: rates, offsets, gaps, jitter, rounding, ends.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "app/media/depth_follower.h"

namespace relievo {
namespace {

using std::chrono::milliseconds;

Frame depthAt(double ms) {
  Frame frame;
  frame.pts = mediaTime(ms * 1e-3);
  static const std::uint8_t sample = 0;
  frame.planes[0].data = &sample;
  return frame;
}

// A depth track with pictures at the given times, in ms.
struct Track {
  std::vector<double> times;
  std::size_t next = 0;
  bool dry = false;  // returns nothing for now
  std::optional<Error> error;
  DepthFollower follower{[this]() -> Result<DepthFollower::Supplied> {
    if (error) return std::unexpected(*error);
    if (dry) return DepthFollower::Supplied{};
    if (next == times.size()) return DepthFollower::Supplied{std::nullopt, true};
    return DepthFollower::Supplied{depthAt(times[next++]), false};
  }};

  explicit Track(std::vector<double> t) : times(std::move(t)) {}
  Track(const Track&) = delete;
  Track& operator=(const Track&) = delete;

  // The time in ms of the depth found, -1 for none; minus (1000 + time) if it is mismatched.
  double at(double color_ms) {
    const auto match = follower.at(mediaTime(color_ms * 1e-3)).value();
    if (match.depth.empty()) return match.matched ? -1 : -2;
    const double ms = static_cast<double>(match.depth.pts.time_since_epoch().count()) / 1e6;
    return match.matched ? ms : -1000 - ms;
  }
  std::vector<double> at(const std::vector<double>& colors) {
    std::vector<double> found;
    for (const double color : colors) found.push_back(at(color));
    return found;
  }
};

std::vector<double> every(double period_ms, int count, double start_ms = 0) {
  std::vector<double> times;
  for (int k = 0; k < count; ++k) times.push_back(start_ms + k * period_ms);
  return times;
}

using Times = std::vector<double>;

// The camera has not taken the next depth picture yet: waiting for it would cost a period.
TEST(DepthFollower, ForAPictureOfTheColoursOwnTimeItDoesNotLookAtTheNext) {
  Track track(every(40, 20));
  track.follower.setLive(true);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(track.at(40 * k + (k % 3 - 1)), 40 * k) << "within a millisecond";
    EXPECT_EQ(track.next, static_cast<std::size_t>(k) + 1) << k;
  }
}

TEST(DepthFollower, EqualTimesBelongTogether) {
  Track track(every(40, 5));
  EXPECT_EQ(track.at(every(40, 5)), every(40, 5));
  EXPECT_EQ(track.follower.skipped(), 0u);
}

// An eighth of the period, but no less than 1 ms and no more than 4.
TEST(DepthFollower, ADepthThatIsToComeIsNotTakenForThePresentOne) {
  Track slow(every(200, 4));
  EXPECT_EQ(slow.at(Times{0, 195, 197}), (Times{0, 0, 200}));
  Track fast(every(4, 6));
  EXPECT_EQ(fast.at(Times{0, 2.8, 3.2}), (Times{0, 0, 4}));
}

TEST(DepthFollower, ALowerRateIsHeld) {
  Track track(every(80, 3));
  EXPECT_EQ(track.at(every(40, 6)), (Times{0, 0, 80, 80, 160, 160}));
}

TEST(DepthFollower, AHigherRateIsThinnedAndCounted) {
  Track track(every(20, 9));
  EXPECT_EQ(track.at(every(40, 5)), (Times{0, 40, 80, 120, 160}));
  EXPECT_EQ(track.follower.skipped(), 4u);  // 20, 60, 100, 140
}

// 24 pictures/s on 30: the newest one at or before, never older than 33.3 ms. Both rates coincide every 166.7 ms.
TEST(DepthFollower, RatesThatAreNoMultiplesTakeTheNewestAtOrBefore) {
  Track track(every(100.0 / 3, 31));
  const std::vector<int> expected{0, 1, 2, 3, 5, 6, 7, 8, 10};
  for (int k = 0; k < 9; ++k) {
    EXPECT_NEAR(track.at(k * 125.0 / 3), expected[static_cast<std::size_t>(k)] * 100.0 / 3, 1e-3) << k;
  }
}

// The other way round: 30 colour pictures/s with 24 of depth; one depth picture in four is held.
TEST(DepthFollower, ASlightlyLowerRateIsNeverAMismatch) {
  Track track(every(125.0 / 3, 25));
  for (int k = 0; k < 30; ++k) EXPECT_GE(track.at(k * 100.0 / 3), 0.0) << k;
}

TEST(DepthFollower, MillisecondsOfTwoContainersDoNotSeparateWhatBelongsTogether) {
  // 30 frames/s from 0.4 ms on, rounded to ms, minus the rounded start: up to 0.9 ms from the exact times of an MP4.
  Times rounded, exact;
  for (int k = 0; k < 90; ++k) {
    rounded.push_back(std::round(40.4 + k * 100.0 / 3) - 40);
    exact.push_back(k * 100.0 / 3);
  }
  Track depth_rounded(rounded);
  Track depth_exact(exact);
  for (std::size_t k = 0; k < exact.size(); ++k) {
    EXPECT_NEAR(depth_rounded.at(exact[k]), rounded[k], 1e-3) << k;
    EXPECT_NEAR(depth_exact.at(rounded[k]), exact[k], 1e-3) << k;
  }
}

TEST(DepthFollower, JitterOfThreeMillisecondsIsNoMismatch) {
  const Times jitter{2, -3, 1, 3, -2, 0, 3, -1, -3, 2};
  Times depth;
  for (int k = 0; k < 60; ++k) depth.push_back(100 + k * 40 + jitter[static_cast<std::size_t>(k) % 10]);
  Track track(depth);
  for (int k = 0; k < 60; ++k) EXPECT_EQ(track.at(100 + k * 40), depth[static_cast<std::size_t>(k)]) << k;
  EXPECT_EQ(track.follower.skipped(), 0u);
}

TEST(DepthFollower, DepthThatBeginsLaterIsMissingBeforeAndNoMismatch) {
  Track track(every(40, 4, 60));
  EXPECT_EQ(track.at(every(40, 4)), (Times{-1, -1, 60, 100}));
}

TEST(DepthFollower, DepthFromBeforeTheColourIsSkipped) {
  Track track(every(40, 4));
  EXPECT_EQ(track.at(Times{80, 120}), (Times{80, 120}));
  EXPECT_EQ(track.follower.skipped(), 2u);
}

TEST(DepthFollower, DepthThatEndsLastsItsPeriodAndThenThereIsNone) {
  Track equal(every(40, 3));
  EXPECT_EQ(equal.at(every(40, 5)), (Times{0, 40, 80, -1, -1}));
  Track half(every(80, 2));
  EXPECT_EQ(half.at(every(40, 5)), (Times{0, 0, 80, 80, -1}));
}

TEST(DepthFollower, AStillIsHeldForEver) {
  Track track({0});
  EXPECT_EQ(track.at(Times{0, 40, 100000}), (Times{0, 0, 0}));
}

TEST(DepthFollower, AMissingPictureIsAMismatchForAsLongAsItLacks) {
  Track equal({0, 40, 80, 160, 200, 320, 360});  // without 120, 240, 280
  EXPECT_EQ(equal.at(every(40, 10)), (Times{0, 40, 80, -1080, 160, 200, -1200, -1200, 320, 360}));
  Track half({0, 80, 240, 320});  // without 160
  EXPECT_EQ(half.at(every(40, 8)), (Times{0, 0, 80, 80, -1080, -1080, 240, 240}));
}

// Always a quarter of a period late: each depth picture is nearly a period old when the next colour picture comes.
TEST(DepthFollower, AnOffsetIsNoMismatch) {
  Track track(every(40, 20, 10));
  EXPECT_EQ(track.at(0), -1);
  for (int k = 1; k < 19; ++k) EXPECT_EQ(track.at(k * 40), 10 + (k - 1) * 40) << k;
}

// The delay alternates around the tolerance: the older picture is then nearly a period old, but none is missing.
TEST(DepthFollower, JitterAroundTheToleranceIsNoMismatch) {
  Times depth;
  for (int k = 0; k < 20; ++k) depth.push_back(40 * k + (k % 2 == 0 ? 6.5 : 2.5));
  Track track(depth);
  for (int k = 1; k < 18; ++k) EXPECT_EQ(track.at(40 * k), 40 * (k % 2 == 0 ? k - 1 : k) + 2.5) << k;
}

TEST(DepthFollower, ATrackThatIsDryForNowIsAMismatchAndComesBack) {
  Track track(every(40, 6));
  EXPECT_EQ(track.at(every(40, 2)), (Times{0, 40}));
  track.dry = true;
  EXPECT_EQ(track.at(Times{80, 120}), (Times{80, -1080}));  // 80 was read ahead
  track.dry = false;
  EXPECT_EQ(track.at(160), 160);
}

TEST(DepthFollower, PeekTakesNothing) {
  Track track(every(40, 2));
  EXPECT_EQ((*track.follower.peek())->pts, mediaTime(0));
  EXPECT_EQ((*track.follower.peek())->pts, mediaTime(0));
  EXPECT_EQ(track.at(every(40, 2)), every(40, 2));
  EXPECT_EQ(*track.follower.peek(), nullptr);
}

TEST(DepthFollower, AfterASeekWhatLiesBeforeTheTargetIsNotCounted) {
  Track track(every(40, 20));
  EXPECT_EQ(track.at(0), 0);
  track.next = 2;
  track.follower.restart();
  EXPECT_EQ(track.at(400), 400);
  EXPECT_EQ(track.follower.skipped(), 0u);
  EXPECT_EQ(track.at(480), 480);
  EXPECT_EQ(track.follower.skipped(), 1u);
  track.next = 0;  // and backward
  track.follower.restart();
  EXPECT_EQ(track.at(40), 40);
}

TEST(DepthFollower, ThePeriodIsThatOfTheTimestampsWhateverIsMissing) {
  Track track({0, 33, 67, 100, 200, 233, 267, 300});
  static_cast<void>(track.at(270));
  EXPECT_EQ(track.follower.period(), milliseconds(33));
}

TEST(DepthFollower, ErrorsOfTheTrackAreHandedOn) {
  Track track(every(40, 3));
  EXPECT_EQ(track.at(0), 0);
  track.error = Error{ErrorCode::Lost, 0, "gone"};
  const auto match = track.follower.at(mediaTime(0.04));
  ASSERT_FALSE(match.has_value());
  EXPECT_EQ(match.error().code, ErrorCode::Lost);
}

}  // namespace
}  // namespace relievo
