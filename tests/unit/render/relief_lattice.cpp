// SPDX-License-Identifier: Apache-2.0
// The heights under the relief: holes, jumps, and how many triangles they take.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/render/relief/cut_cells.h"
#include "app/render/relief/relief_triangles.h"
#include "app/render/relief/silhouette.h"
#include "app/render/relief/stereo.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/render/drawn_relief.h"

namespace relievo::test {
namespace {

TEST(HeightLattice, ARowThatNobodyMeasuredLiesOnTheFarPlane) {
  const HeightLattice lattice = latticeOf([](int, int) { return kHole; });
  EXPECT_EQ(std::count(lattice.heights(), lattice.heights() + lattice.size(), 0.0F),
            static_cast<std::ptrdiff_t>(lattice.size()));
}

TEST(HeightLattice, AHoleTakesTheHeightOfItsFartherSideWhicheverThatIs) {
  for (const bool left_is_far : {false, true}) {
    const HeightLattice lattice = latticeOf([&](int c, int) {
      return c >= 20 && c < 24 ? kHole : (c < 20) == left_is_far ? 5.0 : 30.0;
    });
    for (int i = 20; i < 24; ++i) EXPECT_NEAR(lattice.heights()[i], 5, 0.01) << left_is_far << ' ' << i;
  }
}

// A jump between two samples is at least four times their pitch high, and never lower than a millimetre. A picture of
// one row or column has the pitch of its other side.
TEST(HeightLattice, AJumpIsFourTimesAsSteepAsWideAndAMillimetreAtLeast) {
  const auto flat = [](int, int) { return 5.0; };
  EXPECT_NEAR(latticeOf(flat, 41, 1).jumpMm(), 4 * 160.0 / 41, 1e-3);
  EXPECT_NEAR(latticeOf(flat, 1, 9).jumpMm(), 4 * 80.0 / 9, 1e-3);
  EXPECT_NEAR(latticeOf(flat, 1601, 17).jumpMm(), 1, 1e-6);
}

// Samples are read by runs of 16.
TEST(HeightLattice, AHoleThatIsAWholeRunEndsWhereItEnds) {
  const HeightLattice lattice = latticeOf([](int c, int) { return c >= 16 && c < 32 ? kHole : c < 16 ? 5.0 : 30.0; });
  for (int i = 14; i < 35; ++i) EXPECT_NEAR(lattice.heights()[i], i < 32 ? 5 : 30, 0.01) << i;
}

// The hole of the second row is wider than that of the first and has a lower neighbour.
TEST(HeightLattice, WhatIsFilledHasNoJumps) {
  const auto height = [](int c, int r) {
    if (r == 0) return c >= 20 && c < 40 ? kHole : 30.0;
    return c >= 5 && c < 40 ? kHole : c < 5 ? 2.0 : 30.0;
  };
  const HeightLattice lattice = latticeOf(height);
  const float* second = lattice.heights() + lattice.cols();
  for (int c = 6; c < 40; ++c) EXPECT_LE(std::abs(second[c] - second[c - 1]), 0.5001F * lattice.jumpMm()) << c;
  EXPECT_GT(*std::max_element(second + 5, second + 40), 15) << "it follows the row above";
}

TEST(ReliefTriangles, AFrameJoinsTheReliefToThePicturesRectangle) {
  const Frame frame = frameOf([](int, int) { return 30.0; });
  ReliefTriangles relief;
  relief.build(fieldOf(frame), kVolume, {});
  const float screen_mm = 20;
  int left = 0, right = 0, above = 0, below = 0;
  const auto& at = relief.vertices();
  for (std::size_t i = 0; i + 2 < relief.indices().size(); i += 3) {
    bool on_relief = false, on_screen = false;
    float x = 0, y = 0;
    for (std::size_t k = i; k < i + 3; ++k) {
      const TexturedVertex& v = at[relief.indices()[k]];
      on_relief = on_relief || std::abs(v.z - 30) < 0.01F;
      on_screen = on_screen || v.z == screen_mm;
      if (v.z == screen_mm) x = v.x, y = v.y;
    }
    if (!on_relief || !on_screen) continue;
    left += x == -80;
    right += x == 80;
    above += y == 40;
    below += y == -40;
  }
  for (const int side : {left, right, above, below}) EXPECT_GT(side, 1);
}

// The same scene side by side on 1280 x 720, from depth pictures of three sizes: waves, and a disc before them.
TEST(ReliefTriangles, ALargerDepthPictureTakesNoMoreTrianglesOnTheSameScreen) {
  const StereoSettings stereo{.layout = StereoLayout::SideBySide};
  const DisplayVolume volume{160.0, 108.0, 40.0};
  const EyeViews eyes = eyeViews(stereo, volume, 1280, 720);
  const ReliefDetail detail{.most_across = ReliefDetail::cellsFor(eyes.pixels_per_mm * volume.width_mm),
                            .error_mm = 0.5 * heightOfPixelMm(stereo, volume, eyes.pixels_per_mm)};
  EXPECT_GE(detail.most_across, 533) << "a cell for each of the picture's pixels";
  std::size_t small = 0, small_cuts = 0;
  for (const int times : {1, 2, 4}) {
    const int cols = 720 * times, rows = 486 * times;
    const Frame frame = makeGrayFrame(cols, rows, 16, MediaTime{}, [&](int c, int r) {
      const float x = static_cast<float>(c) / static_cast<float>(cols),
                  y = static_cast<float>(r) / static_cast<float>(rows);
      const bool on_disc = (x - 0.4F) * (x - 0.4F) + (y - 0.5F) * (y - 0.5F) < 0.04F;
      return static_cast<std::uint32_t>((on_disc ? 50'000.0F : 15'000.0F) + 30'000.0F * x * (1 - x) * (1 - y));
    });
    ReliefTriangles relief;
    relief.build(HeightField::make(frame, {.bits = 16}, volume).value(), volume, detail);
    const std::size_t count = relief.indices().size() / 3;
    if (times == 1) small = count, small_cuts = relief.cutCells();
    EXPECT_LE(static_cast<double>(count), 1.2 * static_cast<double>(small)) << times;
    EXPECT_LE(static_cast<double>(relief.cutCells()), 1.2 * static_cast<double>(small_cuts)) << times;
    EXPECT_GT(relief.cutCells(), 500U);
    EXPECT_LE(static_cast<double>(relief.samples()), 1.2 * 720 * 486) << times;
  }
}

// An error of 2 px instead of half of one hardly matters to a picture of outlines; a wider pitch does.
TEST(ReliefTriangles, ALargerErrorTakesFewerTrianglesAlongOutlinesToo) {
  EXPECT_EQ(ReliefDetail::cellsFor(540), 720);
  EXPECT_EQ(ReliefDetail::cellsFor(540, 1.5), 480);
  EXPECT_EQ(ReliefDetail::cellsFor(540, 8), 360) << "at most twice as wide";
  const Frame frame = makeGrayFrame(720, 486, 16, MediaTime{},
                                    [](int c, int r) { return (c / 60 + r / 60) % 2 == 0 ? 10'000U : 50'000U; });
  const HeightField field = HeightField::make(frame, {.bits = 16}, kVolume).value();
  const auto count = [&](double factor) {
    ReliefTriangles relief;
    relief.build(field, kVolume, {.most_across = ReliefDetail::cellsFor(540, factor), .error_mm = 0.5 * factor});
    return static_cast<double>(relief.indices().size());
  };
  EXPECT_LT(count(2), 0.6 * count(1));
}

TEST(ReliefTriangles, WhatStandsStillIsNotMadeAgain) {
  const auto pictureOf = [](int raised) {
    return frameOf([=](int c, int r) { return c == raised && r == 7 ? 30.0 : c < kEdge ? 5.0 : 25.0; });
  };
  const Frame first = pictureOf(-1), same = pictureOf(-1), other = pictureOf(12);
  ReliefTriangles relief;
  ReliefDetail detail;
  EXPECT_TRUE(relief.build(fieldOf(first), kVolume, detail));
  const std::size_t triangles = relief.indices().size();
  EXPECT_FALSE(relief.build(fieldOf(same), kVolume, detail));
  EXPECT_EQ(relief.indices().size(), triangles);
  EXPECT_TRUE(relief.build(fieldOf(other), kVolume, detail)) << "one sample has risen";
  EXPECT_GT(relief.indices().size(), triangles);
  EXPECT_TRUE(relief.build(fieldOf(same), kVolume, detail)) << "it has sunk again";
  EXPECT_EQ(relief.indices().size(), triangles);
  detail.view.eye_mm *= 2;
  EXPECT_TRUE(relief.build(fieldOf(same), kVolume, detail)) << "seen from elsewhere";
  DisplayVolume deeper = kVolume;
  deeper.depth_mm *= 2;
  EXPECT_TRUE(relief.build(HeightField::make(same, {.bits = 16}, deeper).value(), deeper, detail));
}

}  // namespace
}  // namespace relievo::test
