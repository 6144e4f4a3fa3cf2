// SPDX-License-Identifier: Apache-2.0
// Pictures that are left out for lack of time: the depth between them stays, and key frames are reached sooner.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "app/media/pair_reader.h"
#include "drivers/mock/mock.h"
#include "platform/clock.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds(40);
constexpr int kFrames = 100, kKeyInterval = 25;

class PairLate : public testing::Test {
 protected:
  PairLate() { setLogLevel(LogLevel::Error); }

  static MockTrack track(ColorModel model, int key_interval) {
    MockTrack track{.width = 16, .height = 12, .model = model, .frames = kFrames, .frame_period = kPeriod};
    track.keyframe_interval = key_interval;
    return track;
  }

  void open(std::vector<MockTrack> tracks) {
    film_.tracks = std::move(tracks);
    ASSERT_TRUE(reader_.open({.url = "film"}));
  }
  // The numbers of the next pairs' pictures.
  std::vector<int> next(int pairs) {
    std::vector<int> numbers;
    for (int i = 0; i < pairs; ++i) {
      auto pair = reader_.next();
      if (!pair || !*pair) break;
      numbers.push_back(static_cast<int>((*pair)->color.pts.time_since_epoch() / kPeriod));
      last_ = std::move(**pair);
    }
    return numbers;
  }

  ManualClock clock_;
  MockMediaProfile film_;
  FramePair last_;
  // Every second picture is referred to by no other.
  PairReader reader_{
      {.make_source = [this](const std::string&) { return makeMockSource(film_, clock_); },
       .make_decoder =
           [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32, .referenced_every = 2}); },
       .clock = &clock_}};
};

TEST_F(PairLate, WhereColorIsLeftOutTheDepthGoesOn) {
  open({track(ColorModel::Yuv, 1), track(ColorModel::Gray, 1)});
  next(10);
  reader_.leaveOut(true);
  next(10);  // what had been decoded before
  for (int i = 20; i < 60; ++i) {
    ASSERT_EQ(next(1), std::vector<int>{i});
    EXPECT_EQ(last_.stands, i % 2 == 1) << i;
    EXPECT_EQ(last_.color.empty(), i % 2 == 1) << i;
    ASSERT_FALSE(last_.depth.empty()) << i;
    EXPECT_EQ(last_.depth.pts, MediaTime(i * kPeriod)) << "each picture has the depth of its own time";
    EXPECT_TRUE(last_.matched);
  }
  EXPECT_GE(reader_.counters().left_out, 20u);
  EXPECT_EQ(reader_.counters().depth_skipped, 0u);
  reader_.leaveOut(false);
  next(10);
  for (int i = 70; i < kFrames; ++i) {
    ASSERT_EQ(next(1), std::vector<int>{i});
    EXPECT_FALSE(last_.stands) << i;
  }
  EXPECT_TRUE(next(1).empty());
}

TEST_F(PairLate, WithoutDepthOfItsOwnPicturesAreMissing) {
  open({track(ColorModel::Yuv, 1)});
  reader_.leaveOut(true);
  next(10);
  const std::vector<int> numbers = next(5);
  for (std::size_t i = 1; i < numbers.size(); ++i) EXPECT_EQ(numbers[i] - numbers[i - 1], 2);
}

TEST_F(PairLate, AHurryGoesToTheLastKeyFrameBeforeItsTime) {
  open({track(ColorModel::Yuv, kKeyInterval), track(ColorModel::Gray, kKeyInterval)});
  next(5);
  reader_.leaveOut(false, MediaTime(60 * kPeriod));
  std::vector<int> numbers = next(60);
  const auto landed = std::ranges::find(numbers, 50);
  ASSERT_NE(landed, numbers.end());
  EXPECT_LT(landed - numbers.begin(), 10) << "only what had been decoded before";
  EXPECT_EQ(*(landed + 1), 51);
  EXPECT_EQ(last_.depth.pts, last_.color.pts);
}

TEST_F(PairLate, AHurryWithoutAKeyFrameAheadLeavesNothingOut) {
  open({track(ColorModel::Yuv, kKeyInterval), track(ColorModel::Gray, kKeyInterval)});
  next(5);
  reader_.leaveOut(false, MediaTime(20 * kPeriod));
  for (int i = 5; i < 40; ++i) ASSERT_EQ(next(1), std::vector<int>{i});
}

// Depth whose every picture is a key frame begins at the colour's, not later.
TEST_F(PairLate, DepthIsReachedWhereTheColorIs) {
  open({track(ColorModel::Yuv, kKeyInterval), track(ColorModel::Gray, 1)});
  next(5);
  reader_.leaveOut(false, MediaTime(60 * kPeriod));
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(next(1).size(), 1u);
    EXPECT_EQ(last_.depth.pts, last_.color.pts);
  }
}

}  // namespace
}  // namespace relievo
