// SPDX-License-Identifier: Apache-2.0
// The relief of a level of detail as a depth picture: what a triangle makes of the samples that it covers.
#include "app/lab/detail/drawn_depth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/render/relief/stereo.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr int kCols = 97, kRows = 65;
constexpr DisplayVolume kVolume{97, 65, 40};  // a millimetre a sample
constexpr double kPixelsPerMm = 4;

template <class Height>
Frame relief(Height&& height) {
  return test::makeReliefFrame(kCols, kRows, kVolume, {}, height);
}
HeightField fieldOf(const Frame& frame) {
  return HeightField::make(frame, {.bits = 16}, kVolume).value();
}
double greatestDifference(const Frame& a, const Frame& b) {
  const HeightField x = fieldOf(a), y = fieldOf(b);
  double greatest = 0;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) greatest = std::max(greatest, std::abs(x.heightMm(c, r) - y.heightMm(c, r)));
  }
  return greatest;
}
DrawnDepth drawn(const Frame& depth, const DrawnLevel& level) {
  return drawnDepth(fieldOf(depth), kVolume, level, kPixelsPerMm);
}

Frame hills() {
  return relief([](double x, double y) { return 20 + 8 * std::sin(0.11 * x) * std::cos(0.13 * y); });
}

TEST(DrawnDepth, OfAllSamplesIsTheDepthItself) {
  const DrawnDepth all = drawn(hills(), {.grid_step = 1});
  EXPECT_EQ(all.triangles, 2U * (kCols - 1) * (kRows - 1));
  EXPECT_EQ(greatestDifference(all.frame, hills()), 0);
}

TEST(DrawnDepth, APlaneStaysWhatItIsAtEveryLevel) {
  const Frame plane = relief([](double x, double y) { return 20 + 0.1 * x - 0.2 * y; });
  for (const DrawnLevel& level : {DrawnLevel{.grid_step = 5}, {.grid_step = 12}, {.error_px = 4}}) {
    EXPECT_LT(greatestDifference(drawn(plane, level).frame, plane), 0.0013) << level.grid_step;  // a code is 0.0006
  }
  EXPECT_LT(drawn(plane, {.error_px = 4}).triangles, 100U);
}

// A single sample of 8 mm at (12, 12) is a corner of grids whose step divides 12. The cell to its lower right ends at
// (16, 16), and its diagonal starts at the sample: half way down that slope the height is 4 mm. The place (14, 13)
// beside the diagonal lies in the triangle (12, 12), (16, 16), (16, 12): 8 (1 - 2/4).
TEST(DrawnDepth, AGridGoesStraightBetweenItsSamples) {
  const Frame spike = relief([](double x, double y) { return x == -36 && y == 20 ? 8.0 : 0.0; });
  ASSERT_NEAR(fieldOf(spike).heightMm(12, 12), 8, 0.001);
  const DrawnDepth by_four = drawn(spike, {.grid_step = 4});
  EXPECT_EQ(by_four.triangles, 2U * 24 * 16);
  const HeightField field = fieldOf(by_four.frame);
  EXPECT_NEAR(field.heightMm(12, 12), 8, 0.001);
  EXPECT_NEAR(field.heightMm(14, 14), 4, 0.001);
  EXPECT_NEAR(field.heightMm(14, 13), 4, 0.001);
  EXPECT_NEAR(field.heightMm(13, 15), 2, 0.001);  // in (12, 12), (12, 16), (16, 16): 8 (1 - 3/4)
  EXPECT_NEAR(field.heightMm(14, 11), 2, 0.001);  // in the cell above no diagonal meets the sample: 8 (1 - 2/4 - 1/4)
  EXPECT_EQ(field.heightMm(16, 12), 0);
  EXPECT_EQ(greatestDifference(drawn(spike, {.grid_step = 5}).frame, relief([](double, double) { return 0.0; })), 0);
}

TEST(DrawnDepth, ANetworkKeepsWithinItsError) {
  for (const double error_px : {0.125, 0.5, 2.0}) {
    const DrawnDepth network = drawn(hills(), {.error_px = error_px});
    const double error_mm = error_px * heightOfPixelMm({}, kVolume, kPixelsPerMm);
    const double greatest = greatestDifference(network.frame, hills());
    EXPECT_LE(greatest, error_mm + 0.0013) << error_px;
    EXPECT_GT(greatest, 0.1 * error_mm) << error_px;
  }
}

// All cells of a wall one sample thick are cut: no triangle reaches its samples.
TEST(DrawnDepth, WhereANetworkIsCutTheSamplesStay) {
  const Frame wall = relief([](double x, double) { return x == 3 ? 30.0 : 5.0; });
  EXPECT_LT(greatestDifference(drawn(wall, {.error_px = 1}).frame, wall), 0.0013);
}

}  // namespace
}  // namespace relievo
