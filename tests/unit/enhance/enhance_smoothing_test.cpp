// SPDX-License-Identifier: Apache-2.0
// Noise and smoothing against closed forms: the results for a plane, an impulse, a step and a steady motion.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "app/enhance/edge_keeping_fit.h"
#include "app/enhance/noise.h"
#include "app/enhance/shape_change.h"
#include "app/enhance/steady_mean.h"
#include "tests/support/film/depth_map.h"

namespace relievo {
namespace {

using test::mapOf;

TEST(EnhanceNoise, IsThatOfTheSamplesWhateverTheSurface) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 1);
  for (const double sigma : {40.0, 257.0, 1028.0}) {
    const auto map = mapOf(
        200, 150, [&](int c, int r) { return 20000 + (c < 90 ? 20000 : 0) + 60 * c + 30 * r + sigma * noise(random); });
    EXPECT_NEAR(static_cast<double>(noiseOf(map)), sigma, 0.06 * sigma);
  }
  EXPECT_EQ(noiseOf(mapOf(200, 150, [](int c, int r) { return 100 * c + 40 * r; })), 0);
}

TEST(EnhanceNoise, IsNoneWhereNothingCanBeTold) {
  EXPECT_EQ(noiseOf(mapOf(2, 2, [](int c, int r) { return 9000 * (c ^ r); })), 0);
  DepthMap map = mapOf(30, 30, [](int c, int r) { return 9000 * ((c ^ r) & 1); });
  map.holes.assign(map.size(), 1);
  EXPECT_EQ(noiseOf(map), 0);
}

// Half of the picture raised by 100 codes: an rms change of 100 sqrt(1/2).
TEST(EnhanceShapeChange, IsThatOfWholeBlocksWithoutHolesAndSteps) {
  DepthMap map(64, 32);
  std::fill(map.codes.begin(), map.codes.end(), 1000.0F);
  map.holes[map.at(3, 3)] = 1;
  const auto before = blockMeans(map);
  EXPECT_EQ(shapeChange(before, map), 0);
  for (int r = 0; r < 32; ++r) {
    for (int c = 0; c < 32; ++c) map.codes[map.at(c, r)] += 100;
  }
  EXPECT_NEAR(shapeChange(before, map), 100 * std::sqrt(15.0 / 31), 0.01);
  for (int c = 0; c < 64; ++c) map.codes[map.at(c, 12)] += 2 * DepthMap::kStep;  // through the second row of blocks
  EXPECT_NEAR(shapeChange(before, map), 100 * std::sqrt(11.0 / 23), 0.01);
  EXPECT_EQ(shapeChange({}, DepthMap(7, 7)), 0);
}

TEST(EnhanceFit, SpreadsAnImpulseAsTwoMeansEachWay) {
  constexpr int kReach = 3;
  constexpr double kImpulse = 1000, n = 2 * kReach + 1;
  auto map = mapOf(41, 41, [](int c, int r) { return c == 20 && r == 20 ? kImpulse : 0; });
  fitLines(map, kReach);
  double sum = 0, squares = 0;
  for (const float code : map.codes) {
    sum += static_cast<double>(code) / kImpulse;
    squares += std::pow(static_cast<double>(code) / kImpulse, 2);
  }
  const double one_way = (2 * n * n + 1) / (3 * n * n * n);
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_NEAR(squares, one_way * one_way, 1e-6);
}

TEST(EnhanceFit, LeavesPlanesAsTheyAreUpToTheirEdges) {
  for (const int reach : {1, 4, 30}) {
    auto map =
        mapOf(50, 40, [](int c, int r) { return c + 0.3 * r < 22 ? 40000 + 90 * c + 7 * r : 9000 - 50 * c + 80 * r; });
    map.holes[map.at(10, 10)] = 1;
    const DepthMap before = map;
    fitLines(map, reach);
    for (std::size_t i = 0; i < map.size(); ++i) {
      if (map.holes[i] != 0) continue;
      EXPECT_NEAR(map.codes[i], before.codes[i], 0.1) << "reach " << reach << " at " << i;
    }
  }
}

TEST(EnhanceFit, NothingCrossesAStepOrAHole) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> noise(-300, 300);
  const auto base = mapOf(50, 40, [&](int c, int) { return (c < 20 ? 40000 : 9000) + noise(random); });
  const auto fitted = [](DepthMap map) {
    for (int r = 0; r < map.rows; ++r) map.holes[map.at(35, r)] = 1;
    fitLines(map, 5);
    return map;
  };
  DepthMap other = base;
  for (int r = 0; r < other.rows; ++r) {
    for (int c = 20; c < 35; ++c)
      other.codes[other.at(c, r)] += 0.3F * static_cast<float>(r * c % 17) * noise(random) / 10;
  }
  const DepthMap a = fitted(base), b = fitted(other);
  for (int r = 0; r < base.rows; ++r) {
    for (int c = 0; c < base.cols; ++c) {
      if (c >= 20 && c <= 35) continue;
      EXPECT_EQ(a.codes[a.at(c, r)], b.codes[b.at(c, r)]) << c << " " << r;
    }
  }
  EXPECT_NE(a.codes[a.at(25, 20)], b.codes[b.at(25, 20)]);
}

TEST(EnhanceFit, TakesTheSmallestPictures) {
  for (const auto& [cols, rows] : {std::pair{1, 1}, {2, 2}, {1, 9}, {9, 1}}) {
    auto map = mapOf(cols, rows, [](int c, int r) { return 100 * c + 30 * r; });
    const DepthMap before = map;
    fitLines(map, 4);
    for (std::size_t i = 0; i < map.size(); ++i) EXPECT_NEAR(map.codes[i], before.codes[i], 0.05);
  }
}

class EnhanceSteadyMean : public testing::Test {
 protected:
  // One sample over five pictures; the present one is the third.
  static float middle(const std::array<float, 5>& codes, float alike, int hole = -1) {
    std::array<DepthMap, 5> maps;
    for (int k = 0; k < 5; ++k) {
      maps[k] = mapOf(1, 1, [&](int, int) { return codes[k]; });
      maps[k].holes[0] = k == hole ? 1 : 0;
    }
    const std::array<const DepthMap*, 2> before{&maps[1], &maps[0]}, after{&maps[3], &maps[4]};
    steadyMean(maps[2], before, after, alike, maps[0].codes);  // in the place of the oldest
    return maps[0].codes[0];
  }
};

TEST_F(EnhanceSteadyMean, IsTheMeanOfFive) {
  EXPECT_FLOAT_EQ(middle({1010, 990, 1020, 1000, 980}, 100), 1000);
}
TEST_F(EnhanceSteadyMean, DoesNotLagBehindASteadyMotion) {
  EXPECT_FLOAT_EQ(middle({10000, 10900, 11800, 12700, 13600}, 100), 11800);
}
TEST_F(EnhanceSteadyMean, LeavesOutPairsThatDoNotBelong) {
  EXPECT_FLOAT_EQ(middle({40000, 1010, 1000, 1020, 1000}, 100), 1010) << "the outer pair";
  EXPECT_FLOAT_EQ(middle({1000, 1000, 40000, 1000, 1000}, 100), 40000) << "an edge goes by";
}
TEST_F(EnhanceSteadyMean, LeavesOutHoles) {
  EXPECT_FLOAT_EQ(middle({10, 0, 20, 100, 30}, 100, 1), 20);
  EXPECT_FLOAT_EQ(middle({10, 10, 0, 10, 10}, 100, 2), 0);
}

}  // namespace
}  // namespace relievo
