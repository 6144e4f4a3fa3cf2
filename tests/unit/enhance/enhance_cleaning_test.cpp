// SPDX-License-Identifier: Apache-2.0
// Holes, outliers and the median, on pictures small enough to know the result.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/enhance/cleaning.h"
#include "tests/support/film/depth_map.h"

namespace relievo {
namespace {

constexpr float kNear = 50000, kFar = 10000;

using test::mapOf;

bool isNear(float code) {
  return code > 0.5F * (kNear + kFar);
}

template <class Where>
std::size_t punch(DepthMap& map, Where&& where) {
  std::size_t count = 0;
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) {
      if (!where(c, r)) continue;
      map.holes[map.at(c, r)] = 1;
      map.codes[map.at(c, r)] = 0;
      ++count;
    }
  }
  return count;
}

TEST(EnhanceCleaning, FillsANarrowHoleInAPlaneWithThePlane) {
  auto map = mapOf(160, 90, [](int c, int r) { return 20000 + 50 * c + 20 * r; });
  const DepthMap whole = map;
  const std::size_t holes = punch(map, [](int c, int r) { return std::hypot(c - 80, r - 40) <= 2; });
  const CleaningCounts counts = fillHoles(map, 0);
  EXPECT_EQ(counts.holes, holes);
  EXPECT_EQ(counts.filled, holes);
  EXPECT_EQ(counts.outliers, 0u);
  for (std::size_t i = 0; i < map.size(); ++i) {
    EXPECT_EQ(map.holes[i], 0);
    EXPECT_NEAR(map.codes[i], whole.codes[i], 60);
  }
}

// 160 samples wide: a hole up to 4 wide is filled, since a disc of radius 2 does not fit in it.
TEST(EnhanceCleaning, LeavesAWideHoleAndItsRimAsTheyAre) {
  auto map = mapOf(160, 90, [](int, int) { return kFar; });
  const auto wide = [](int c, int r) { return c >= 60 && c < 90 && r >= 20 && r < 60; };
  punch(map, wide);
  const std::size_t thin = punch(map, [](int c, int r) { return c >= 90 && c < 120 && r >= 30 && r < 33; });
  const CleaningCounts counts = fillHoles(map, 0);
  EXPECT_EQ(counts.holes, 30u * 40 + thin);
  EXPECT_NEAR(static_cast<double>(counts.filled), static_cast<double>(thin), 8) << "corners are cut";
  for (int r = 24; r < 56; ++r) {
    for (int c = 64; c < 86; ++c) EXPECT_EQ(map.holes[map.at(c, r)], 1);
  }
  for (int r = 30; r < 33; ++r) EXPECT_EQ(map.holes[map.at(110, r)], 0);
}

// The area that a camera cannot see beside a near object belongs to the background.
TEST(EnhanceCleaning, FillsAShadowBesideSomethingNearFromBehind) {
  auto map = mapOf(160, 90, [](int c, int) { return c < 70 ? kNear : kFar; });
  punch(map, [](int c, int) { return c >= 70 && c < 74; });
  fillHoles(map, 0);
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c)
      EXPECT_NEAR(map.codes[map.at(c, r)], c < 70 ? kNear : kFar, 0.1) << c << " " << r;
  }
}

TEST(EnhanceCleaning, LeadsAnEdgeStraightThroughAHole) {
  const auto edge = [](int c, int) { return c < 80 ? kNear : kFar; };
  auto map = mapOf(320, 90, edge);
  punch(map, [](int c, int r) { return std::hypot(c - 79.5, r - 40) <= 4; });
  fillHoles(map, 0);
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) EXPECT_NEAR(map.codes[map.at(c, r)], edge(c, r), 0.1) << c << " " << r;
  }
}

TEST(EnhanceCleaning, LeadsASlantedEdgeThroughHolesWithinASample) {
  for (const double slope : {-0.9, -0.5, -0.2, 0.1, 0.35, 0.7, 1.0}) {
    for (int aside = -3; aside <= 3; ++aside) {
      const auto edge = [&](int r) { return 360 + slope * (r - 45); };
      auto map = mapOf(720, 90, [&](int c, int r) { return c < edge(r) ? kNear : kFar; });
      const DepthMap whole = map;
      punch(map, [&](int c, int r) { return std::hypot(c - 360 - aside, r - 45) <= 4; });
      fillHoles(map, 0);
      for (int r = 0; r < map.rows; ++r) {
        int off = 0;
        for (std::size_t i = map.at(0, r); i < map.at(0, r + 1); ++i)
          off += isNear(map.codes[i]) != isNear(whole.codes[i]) ? 1 : 0;
        EXPECT_LE(off, 1) << "slope " << slope << ", hole " << aside << " beside the edge, row " << r;
      }
    }
  }
}

TEST(EnhanceCleaning, FillsASlantedShadowMostlyFromBehind) {
  const auto edge = [](int r) { return 200 + r / 3; };
  auto map = mapOf(720, 90, [&](int c, int r) { return c < edge(r) ? kNear : kFar; });
  const std::size_t holes = punch(map, [&](int c, int r) { return c >= edge(r) && c < edge(r) + 10; });
  fillHoles(map, 0);
  std::size_t near = 0;
  for (int r = 0; r < map.rows; ++r) {
    for (int c = edge(r); c < edge(r) + 10; ++c) near += isNear(map.codes[map.at(c, r)]) ? 1 : 0;
  }
  EXPECT_LT(near, holes / 20);
}

TEST(EnhanceCleaning, ReplacesSalt) {
  auto map = mapOf(160, 90, [](int, int) { return kFar; });
  for (int i = 0; i < 40; ++i) map.codes[map.at(7 + 3 * i, 5 + 2 * i)] = i % 2 == 0 ? 65535 : 0;
  EXPECT_EQ(fillHoles(map, 0).outliers, 40u);
  for (const float code : map.codes) EXPECT_NEAR(code, kFar, 0.1);
}

// A source without holes gets none.
TEST(EnhanceCleaning, MakesNoHoleWhereThereWasNone) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(0, 65535);
  auto map = mapOf(60, 40, [&](int, int) { return any(random); });
  EXPECT_GT(fillHoles(map, 0).outliers, 100u);
  EXPECT_EQ(std::count(map.holes.begin(), map.holes.end(), 1), 0);
}

// In three bands, the last of one row.
TEST(EnhanceCleaning, IsTheMedianWhereThereIsNoStep) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> noise(-400, 400);
  auto map = mapOf(40, 65, [&](int c, int r) { return static_cast<float>(20000 + 20 * c + 10 * r) + noise(random); });
  const DepthMap before = map;
  filterByMedian(map, 200);
  for (int r = 2; r < 63; ++r) {
    for (int c = 2; c < 38; ++c) {
      std::vector<float> around;
      for (int y = r - 2; y <= r + 2; ++y) {
        for (int x = c - 2; x <= c + 2; ++x) around.push_back(before.codes[before.at(x, y)]);
      }
      std::sort(around.begin(), around.end());
      EXPECT_EQ(map.codes[map.at(c, r)], around[12]) << c << " " << r;
    }
  }
}

// A slope of 1,500 codes a sample reaches over three times as far in 5 x 5 as what counts as a step.
TEST(EnhanceCleaning, ASteepSlopeIsNoStep) {
  auto map = mapOf(40, 30, [](int c, int r) { return static_cast<float>(2000 + 1500 * c + 40 * r); });
  const DepthMap before = map;
  filterByMedian(map, 0);
  for (int r = 2; r < 28; ++r) {
    for (int c = 2; c < 38; ++c) EXPECT_EQ(map.codes[map.at(c, r)], before.codes[before.at(c, r)]) << c << " " << r;
  }
}

TEST(EnhanceCleaning, KeepsStepsCornersAndThinLines) {
  auto map = mapOf(60, 40, [](int c, int r) {
    const bool block = c >= 8 && c < 30 && r >= 6 && r < 22, line = c >= 44 && c < 46;
    return block || line ? kNear : kFar;
  });
  const DepthMap before = map;
  filterByMedian(map, 0);
  EXPECT_EQ(map.codes, before.codes);
}

TEST(EnhanceCleaning, PutsWhatHangsInBetweenOnOneOfTheSides) {
  auto map = mapOf(60, 40, [](int c, int) { return c < 30 ? kNear : c == 30 ? 0.5F * (kNear + kFar) : kFar; });
  filterByMedian(map, 0);
  for (int r = 0; r < map.rows; ++r) {
    const float between = map.codes[map.at(30, r)];
    EXPECT_TRUE(between == kNear || between == kFar) << between;
    EXPECT_EQ(map.codes[map.at(29, r)], kNear);
    EXPECT_EQ(map.codes[map.at(31, r)], kFar);
  }
}

TEST(EnhanceCleaning, KnownSamplesAtAHoleDoNotTakeItsCode) {
  constexpr float kLow = 1500;  // less than a step above a hole's code
  auto map = mapOf(60, 40, [](int, int) { return kLow; });
  punch(map, [](int c, int r) { return c > 20 || r > 10; });
  filterByMedian(map, 0);
  for (std::size_t i = 0; i < map.size(); ++i) EXPECT_EQ(map.codes[i], map.holes[i] != 0 ? 0 : kLow);
}

TEST(EnhanceCleaning, TakesTheSmallestPictures) {
  for (const auto& [cols, rows] : {std::pair{1, 1}, {2, 2}, {1, 7}, {7, 1}, {3, 2}}) {
    auto map = mapOf(cols, rows, [](int c, int r) { return 1000 * c + 1500 * r; });
    const DepthMap before = map;
    EXPECT_EQ(fillHoles(map, 0).outliers, 0u);
    EXPECT_EQ(map.codes, before.codes);
    filterByMedian(map, 0);
    punch(map, [](int, int) { return true; });
    EXPECT_EQ(fillHoles(map, 0).filled, 0u);
    filterByMedian(map, 0);
    EXPECT_EQ(std::count(map.holes.begin(), map.holes.end(), 0), 0);
  }
}

}  // namespace
}  // namespace relievo
