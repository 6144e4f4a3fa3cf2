// SPDX-License-Identifier: Apache-2.0
// Exact, rounded and variable rates from timestamps.
#include "app/media/frame_rate.h"

#include <gtest/gtest.h>

namespace relievo {
namespace {

using namespace std::chrono_literals;

StreamInfo stated(int num, int den) {
  StreamInfo stream;
  stream.average_rate = stream.base_rate = {num, den};
  stream.frame_period = fromSeconds(static_cast<double>(den) / num);
  return stream;
}
// Times of `count` pictures at `rate`, cut to whole steps of `clock`.
std::vector<MediaTime> times(double rate, int count, Duration clock) {
  std::vector<MediaTime> all;
  for (int k = 0; k < count; ++k) all.push_back(MediaTime(fromSeconds(k / rate) / clock * clock));
  return all;
}

TEST(FrameRate, ARoundedClockHidesNoExactRate) {
  const FrameRate ntsc = frameRateOf(stated(30000, 1001), times(30000.0 / 1001, 300, 1ms), true);
  EXPECT_FALSE(ntsc.varies());
  EXPECT_EQ(ntsc.exact, (Ratio{30000, 1001}));
  EXPECT_EQ(rateText(ntsc), "29.97 frames a second");
  const FrameRate lying = frameRateOf(stated(25, 1), times(30, 300, 1ms), true);
  EXPECT_FALSE(lying.exact.known()) << "the timestamps say otherwise";
  EXPECT_NEAR(lying.average, 30, 0.01);
  EXPECT_NEAR(frameRateOf(stated(30, 1), times(30000.0 / 1001, 2000, 1us), true).average, 29.97, 0.001)
      << "and tell 29.97 from 30";
}

TEST(FrameRate, AVariableRateHasAnAverageAndARange) {
  // 30 pictures a second, after every third one of 120: 4 pictures in 3/30 + 1/120 s.
  std::vector<MediaTime> all;
  double at = 0;
  for (int k = 0; k < 400; ++k) {
    all.push_back(mediaTime(at));
    at += k % 4 == 3 ? 1.0 / 120 : 1.0 / 30;
  }
  const FrameRate rate = frameRateOf(stated(120, 1), all, true);
  ASSERT_TRUE(rate.varies());
  EXPECT_NEAR(rate.average, 4 / (3.0 / 30 + 1.0 / 120), 0.1);
  EXPECT_NEAR(rate.lowest, 30, 1e-3);
  EXPECT_NEAR(rate.highest, 120, 1e-3);
  EXPECT_EQ(rateText(rate), "36.86 frames a second on average, variable from 30 to 120");
  StreamInfo longer = stated(40, 1);
  EXPECT_EQ(frameRateOf(longer, all, false).average, 40) << "the container has seen the whole film";
}

TEST(FrameRate, OnePictureHasNone) {
  const FrameRate one = frameRateOf(stated(25, 1), {MediaTime{}}, true);
  EXPECT_EQ(rateText(one), "one picture");
  EXPECT_EQ(rateText(frameRateOf(stated(25, 1), {MediaTime{}}, false)), "25 frames a second") << "more may follow";
  EXPECT_EQ(rateText(frameRateOf({}, {}, false)), "rate unknown");
}

TEST(FrameRate, ThePeriodIsThatOfTheAverageWhereTheRateVaries) {
  EXPECT_EQ(framePeriod(33ms, stated(30, 1)), fromSeconds(1.0 / 30)) << "rounded";
  EXPECT_EQ(framePeriod(40ms, stated(30, 1)), 40ms) << "the container is wrong";
  StreamInfo variable = stated(120, 1);
  variable.average_rate = {153, 5};
  EXPECT_NEAR(toSeconds(framePeriod(25ms, variable)), 1 / 30.6, 1e-9);
  EXPECT_EQ(framePeriod(Duration(0), stated(30, 1)), Duration(0));
}

}  // namespace
}  // namespace relievo
