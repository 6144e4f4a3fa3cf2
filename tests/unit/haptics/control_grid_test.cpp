// SPDX-License-Identifier: Apache-2.0
// Block means and their cache: the picture's border, holes, weights, and reuse of cache entries.
#include "app/haptics/method/control_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

// Four samples to a millimetre: a block of 1 mm is 4 x 4 samples.
constexpr int kCols = 41, kRows = 42;
constexpr DisplayVolume kVolume{kCols / 4.0, kRows / 4.0, 40};
constexpr float kPit = -40;

// Codes are hundredths of a millimetre; 0 is a hole.
template <class Code>
TimedSurface picture(double t_s, Code&& code) {
  const Frame f = test::makeGrayFrame(kCols, kRows, 12, mediaTime(t_s), code);
  return test::surfaceOf(f, kVolume, {.bits = 12, .invalid = 0});
}
float height(double code) {
  return static_cast<float>(40 * code / 4095);
}

class ControlGridTest : public testing::Test {
 protected:
  // Frame i is in slot i.
  void show(std::vector<TimedSurface> frames, std::vector<float> weights) {
    frames_ = {};
    for (std::size_t i = 0; i < frames.size(); ++i) {
      window_.frames[i] = frames[i];
      frames_.frame_of_slot[i] = static_cast<std::uint8_t>(i);
      frames_.weight[i] = weights[i];
      if (weights[i] != 0) frames_.wanted |= 1U << i;
    }
    frames_.window = &window_;
    if (!set_) grid_.setPicture(window_.frames[0].field);
    set_ = true;
  }
  Patch patch(int i, int j) {
    Patch p;
    grid_.patch(i, j, frames_, p);
    return p;
  }
  ControlGrid grid_{1.0, 4, 0};
  // The points (i .. i+3, j ..) of a grid that keeps curvature.
  Patch curvedPatch(int i, int j) {
    curved_.setPicture(window_.frames[0].field);
    Patch p;
    curved_.patch(i, j, frames_, p);
    return p;
  }
  static constexpr float kBend = 5.0F / 24;
  ControlGrid curved_{1.0, 4, kBend};
  SurfaceWindow window_;
  ControlGrid::Frames frames_;
  bool set_ = false;
};

TEST_F(ControlGridTest, APointIsTheMeanOfItsBlock) {
  show({picture(0, [](int c, int r) { return 100 + c + 10 * r; })}, {1});
  ASSERT_EQ(grid_.blockCols(), 4);
  const Patch p = patch(2, 5);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(p[static_cast<std::size_t>(j)][i], height(100 + 4 * (2 + i) + 1.5 + 10 * (4 * (5 + j) + 1.5)), 1e-4);
    }
  }
}

// The mean of c^2 over block i is (4 i + 1.5)^2 + 1.25; its second difference is 2 x 4^2 codes, .31 mm.
double meanOfSquares(int i) {
  return std::pow(4 * i + 1.5, 2) + 1.25;
}

TEST_F(ControlGridTest, AHeightKeepsTheCurvature) {
  show({picture(0, [](int c, int r) { return 100 + (c * c + c) / 2 + 2 * r; })}, {1});
  const Patch p = curvedPatch(2, 5);
  for (int i = 0; i < 4; ++i) {
    const double mean = 100 + (meanOfSquares(2 + i) + 4 * (2 + i) + 1.5) / 2 + 2 * (4 * 6 + 1.5);
    EXPECT_NEAR(p[1][i], height(mean - 16 * static_cast<double>(kBend)), 1e-3) << i;
  }
}

// Points are 1 mm apart, so that a bend of 1/kSharpestMm counts in full and twice that not at all: .31 mm are between.
TEST_F(ControlGridTest, ABendSharperThanThatOfAFaceCountsLess) {
  show({picture(0, [](int c, int) { return 100 + c * c; })}, {1});
  const Patch p = curvedPatch(2, 5);
  const float bend = height(32), counts = static_cast<float>(2 / ControlGrid::kSharpestMm) - bend;
  ASSERT_TRUE(counts > 0 && counts < bend);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(p[1][i], height(100 + meanOfSquares(2 + i)) - kBend * counts, 1e-3) << i;
}

TEST_F(ControlGridTest, AnEdgeIsNoCurvature) {
  show({picture(0, [](int c, int) { return c < 20 ? 100 : 3000; })}, {1});
  const Patch p = curvedPatch(3, 5);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(p[0][i], height(i < 2 ? 100 : 3000), 1e-4) << i;
}

TEST_F(ControlGridTest, BesideAHoleTheDepthCountsAsStraight) {
  show({picture(0, [](int c, int) { return c < 8 ? 0 : 10 + 2 * c; })}, {1});
  EXPECT_NEAR(curvedPatch(2, 5)[0][0], height(10 + 2 * 9.5), 1e-3);
  EXPECT_EQ(curvedPatch(1, 5)[0][0], kPit);
}

TEST_F(ControlGridTest, WhatWasReadAheadIsNotReadAgain) {
  show({picture(0, [](int c, int r) { return 100 + c + r; })}, {1});
  curved_.setPicture(window_.frames[0].field);
  for (int tick = 0; tick < 40; ++tick) {
    const std::uint64_t before = curved_.blocksRead();
    curved_.readAhead(2, 5, frames_, 2);
    EXPECT_LE(curved_.blocksRead() - before, 2U) << tick;
  }
  EXPECT_EQ(curved_.blocksRead(), 32U) << "6 x 6 blocks without the corners";
  Patch p;
  curved_.patch(2, 5, frames_, p);
  EXPECT_EQ(curved_.blocksRead(), 32U);
}

// The cache holds 16 x 16 points: one 16 points further on would take the place of one of the patch.
// A point so many columns on takes the place of one that was read.
TEST_F(ControlGridTest, WhatWasReadAheadAndReplacedIsReadAnew) {
  show({picture(0, [](int c, int r) { return 100 + c + r; })}, {1});
  curved_.setPicture(window_.frames[0].field);
  const auto readAll = [&] {
    int ticks = 0;
    while (!curved_.readAhead(2, 5, frames_, 40) && ++ticks < 10) {
    }
  };
  readAll();
  const std::uint64_t before = curved_.blocksRead();
  static_cast<void>(curved_.mean(2 + ControlGrid::kSide, 5, frames_));
  ASSERT_EQ(curved_.blocksRead(), before + 1);
  readAll();
  EXPECT_GT(curved_.blocksRead(), before + 1) << "the block that was replaced";
}
TEST_F(ControlGridTest, WhatIsReadAheadFarAwayLeavesTheLastPatchAsItWas) {
  show({picture(0, [](int c, int r) { return 100 + c + r; })}, {1});
  const Patch before = curvedPatch(2, 5);
  for (int away = 0; away < 20; ++away) curved_.readAhead(2 + away, 5, frames_, 40);
  Patch after;
  curved_.patch(2, 5, frames_, after);
  for (std::size_t j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) EXPECT_EQ(after[j][i], before[j][i]);
  }
}

TEST_F(ControlGridTest, ABlockOnTheBorderCountsFromHalfOfItOn) {
  // 41 columns: one of block 10's four columns is inside; 42 rows: two of its four rows are.
  show({picture(0, [](int, int) { return 1000; })}, {1});
  const Patch p = patch(8, 8);
  EXPECT_NEAR(p[0][1], height(1000), 1e-4);
  EXPECT_EQ(p[0][2], kPit) << "a quarter of it";
  EXPECT_NEAR(p[2][0], height(1000), 1e-4) << "half of it";
  EXPECT_EQ(p[3][0], kPit) << "outside";
  EXPECT_EQ(patch(-2, -2)[1][2], kPit);
}

TEST_F(ControlGridTest, WhereHalfOfTheWeightHasAReadingTheReadingsTell) {
  const auto flat = picture(0, [](int, int) { return 1000; });
  const auto hole = picture(1, [](int, int) { return 0; });
  show({flat, hole}, {0.6F, 0.4F});
  EXPECT_NEAR(patch(3, 3)[1][1], height(1000), 1e-3) << "not 0.6 of it";
  show({flat, hole}, {0.4F, 0.6F});
  EXPECT_EQ(patch(3, 3)[1][1], kPit);
}

// A hole in the last block of a row or in the first one: what lies beyond the rim in memory, the other end of the row
// beside it, is much lower.
TEST_F(ControlGridTest, AHoleAtTheRimIsBridgedByWhatIsInsideThePicture) {
  const auto hole_at = [](int begin) {
    return picture(0, [begin](int c, int) { return c >= begin && c < begin + 4 ? 0 : c < 3 || c >= 37 ? 500 : 3000; });
  };
  show({hole_at(36)}, {1});
  EXPECT_NEAR(patch(9, 4)[0][0], height((4 * 3000 + 500) / 5.0), 1e-3) << "columns 32 to 35, and 40";
  grid_.forgetFrame(0);
  show({hole_at(0)}, {1});
  EXPECT_NEAR(patch(0, 4)[0][0], height(3000), 1e-3) << "columns 4 to 7";
}

TEST_F(ControlGridTest, AnotherFilmsHolesAreAsDeepAsItsBox) {
  show({picture(0, [](int, int) { return 0; })}, {1});
  EXPECT_EQ(patch(3, 3)[0][0], kPit);
  DisplayVolume flatter = kVolume;
  flatter.depth_mm = 20;
  const Frame other = test::makeGrayFrame(kCols, kRows, 12, {}, [](int, int) { return 0; });
  window_.frames[0] = test::surfaceOf(other, flatter, {.bits = 12, .invalid = 0});
  grid_.setPicture(window_.frames[0].field);
  EXPECT_EQ(patch(3, 3)[0][0], -20);
}

TEST_F(ControlGridTest, AFrameThatTakesAnothersPlaceBringsItsOwnReadings) {
  show({picture(0, [](int c, int) { return c < 20 ? 0 : 1000; })}, {1});
  EXPECT_EQ(patch(3, 3)[0][0], kPit);
  EXPECT_NEAR(patch(3, 3)[0][3], height(1000), 1e-4);
  grid_.forgetFrame(0);
  show({picture(1, [](int, int) { return 2000; })}, {1});
  for (const int i : {0, 3}) EXPECT_NEAR(patch(3, 3)[0][i], height(2000), 1e-4) << i;
}

TEST_F(ControlGridTest, APictureOfAnotherShapeIsReadFromTheBeginning) {
  show({picture(0, [](int c, int) { return c < 20 ? 0 : 1000; })}, {1});
  EXPECT_NEAR(patch(3, 3)[0][3], height(1000), 1e-4);
  show({picture(1, [](int, int) { return 2000; })}, {1});
  grid_.setPicture(window_.frames[0].field);
  for (const int i : {0, 3}) EXPECT_NEAR(patch(3, 3)[0][i], height(2000), 1e-4) << i;
}

TEST_F(ControlGridTest, APointThatTakesAnothersPlaceBringsItsOwnReadings) {
  // Point (20, 0), outside the picture, takes the cache entry of (4, 0).
  show({picture(0, [](int c, int) { return c < 20 ? 1000 : 2000; })}, {1});
  EXPECT_NEAR(patch(4, 0)[0][0], height(1000), 1e-4);
  EXPECT_EQ(patch(20, 0)[0][0], kPit);
  EXPECT_NEAR(patch(4, 0)[0][0], height(1000), 1e-4) << "no hole is left behind";
}

TEST_F(ControlGridTest, WhatWasReadIsNotReadAgain) {
  show({picture(0, [](int, int) { return 1000; }), picture(1, [](int, int) { return 1100; })}, {0.5F, 0.5F});
  static_cast<void>(patch(3, 3));
  EXPECT_EQ(grid_.blocksRead(), 2U * 16);
  static_cast<void>(patch(4, 3));
  EXPECT_EQ(grid_.blocksRead(), 2U * 20) << "one column more, in both frames";
  static_cast<void>(patch(3, 3));
  EXPECT_EQ(grid_.blocksRead(), 2U * 20);
}

}  // namespace
}  // namespace relievo
