// SPDX-License-Identifier: Apache-2.0
// What is known of the next pictures: as far as a cut, and by how many pictures they come later.
#include "app/player/film/coming_relief.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 90, 40};

// A wall of one code; a picture takes 40 ms.
Frame wall(int picture, std::uint8_t code) {
  constexpr int kCols = 64, kRows = 36;
  const auto samples = std::make_shared<std::vector<std::uint8_t>>(std::size_t{kCols} * kRows, code);
  Frame frame;
  frame.pts = MediaTime(std::chrono::milliseconds(40 * picture));
  frame.width = kCols, frame.height = kRows;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.planes[0] = {samples->data(), kCols};
  frame.owner = samples;
  return frame;
}

DepthComing comingFrom(int first, const std::vector<std::uint8_t>& codes) {
  DepthComing coming;
  for (const std::uint8_t code : codes) {
    coming.frames[coming.count] = wall(first + static_cast<int>(coming.count), code);
    ++coming.count;
  }
  return coming;
}

bool follow(ComingRelief& relief, int picture, std::uint8_t code, const DepthComing& coming) {
  return relief.follow(wall(picture, code), coming, DepthCalibration{}, kVolume);
}

TEST(ComingRelief, TellsTheHeightsThatComeAndWhen) {
  ComingRelief relief;
  EXPECT_FALSE(follow(relief, 0, 51, comingFrom(1, {53, 55, 57})));
  const ReliefAhead ahead = relief.ahead();
  ASSERT_EQ(ahead.count, 3u);
  EXPECT_TRUE(ahead.more);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(ahead.coming[i].pictures, static_cast<int>(i) + 1);
    ASSERT_EQ(ahead.coming[i].relief->blocks().size(), std::size_t{CoarseRelief::kAcross} * CoarseRelief::kDown);
    EXPECT_NEAR(ahead.coming[i].relief->blocks()[0].height_mm, 40.0 * (53 + 2 * static_cast<int>(i)) / 255, 1e-3);
  }
}

TEST(ComingRelief, EndsAtACutAndBeginsAnewBehindIt) {
  ComingRelief relief;
  EXPECT_FALSE(follow(relief, 0, 50, comingFrom(1, {50, 250, 250})));
  EXPECT_EQ(relief.ahead().count, 1u);
  EXPECT_FALSE(relief.ahead().more) << "what follows the cut is another shot's";
  EXPECT_FALSE(follow(relief, 1, 50, comingFrom(2, {250, 250, 250})));
  EXPECT_EQ(relief.ahead().count, 0u);
  EXPECT_TRUE(follow(relief, 2, 250, comingFrom(3, {250, 250}))) << "the cut itself";
  EXPECT_EQ(relief.ahead().count, 2u);
  EXPECT_TRUE(relief.ahead().more);
}

// Depth that is made while the film plays may be missing for a picture.
TEST(ComingRelief, CountsPicturesWithoutDepth) {
  ComingRelief relief;
  DepthComing coming = comingFrom(1, {50, 52, 54});
  coming.frames[1] = {};
  coming.last = true;
  EXPECT_FALSE(follow(relief, 0, 50, coming));
  ASSERT_EQ(relief.ahead().count, 2u);
  EXPECT_EQ(relief.ahead().coming[1].pictures, 3);
  EXPECT_FALSE(relief.ahead().more) << "the film ends";
}

TEST(ComingRelief, GoesOnAfterPicturesThatWereNotShownAndBackAfterASeek) {
  ComingRelief relief;
  EXPECT_FALSE(follow(relief, 10, 50, comingFrom(11, {50, 50, 50})));
  EXPECT_FALSE(follow(relief, 13, 50, comingFrom(14, {50})));
  EXPECT_EQ(relief.ahead().count, 1u);
  EXPECT_FALSE(follow(relief, 2, 50, comingFrom(3, {50, 50})));
  EXPECT_EQ(relief.ahead().count, 2u);
}

}  // namespace
}  // namespace relievo
