// SPDX-License-Identifier: Apache-2.0
// Drawing keeps within its frame budget, with simulated drawing times.
#include "app/render/relief/detail_level.h"

#include <gtest/gtest.h>

#include <vector>

namespace relievo {
namespace {

using std::chrono::milliseconds;

constexpr Duration kBudget = milliseconds(24);

// A renderer that takes `fixed_ms`, plus `fine_ms` at the finest level in proportion to the triangles, whose number is
// inversely proportional to the error. Returns the level after each frame.
std::vector<int> run(DetailLevel& detail, int frames, double fixed_ms, double fine_ms) {
  std::vector<int> levels;
  for (int i = 0; i < frames; ++i) {
    detail.drew(fromSeconds(1e-3 * (fixed_ms + fine_ms / detail.factor())));
    levels.push_back(detail.level());
  }
  return levels;
}

int changes(const std::vector<int>& levels) {
  int count = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) count += levels[i] != levels[i - 1];
  return count;
}

TEST(DetailLevel, BeginsAsFineAsIsWishedFor) {
  const DetailLevel detail(kBudget);
  EXPECT_EQ(detail.level(), 0);
  EXPECT_EQ(detail.factor(), 1.0);
}

TEST(DetailLevel, GoesCoarserUntilTheBudgetHolds) {
  // 10 + 30 / 2 = 25 ms at level 2, 10 + 30 / 2.83 = 20.6 at level 3.
  DetailLevel detail(kBudget);
  run(detail, 200, 10.0, 30.0);
  EXPECT_EQ(detail.level(), 3);
  EXPECT_NEAR(detail.factor(), 2.828, 0.001);
}

TEST(DetailLevel, GoesFinerAgainWhereHalfTheBudgetIsLeft) {
  DetailLevel detail(kBudget);
  run(detail, 200, 10.0, 30.0);
  run(detail, 200, 3.0, 5.0);
  EXPECT_EQ(detail.level(), 0);
}

TEST(DetailLevel, StopsAtTheCoarsest) {
  DetailLevel detail(kBudget);
  run(detail, 500, 100.0, 0.0);
  EXPECT_EQ(detail.level(), DetailLevel::kCoarsest);
  EXPECT_EQ(detail.factor() / detail.size(), 8.0);
}

TEST(DetailLevel, DrawsSmallerWhereThePixelsCost) {
  // 2 + 40 x size^2 ms: 42 ms at its size; 27.6 at .8; 18.4 at .64.
  DetailLevel detail(kBudget);
  for (int i = 0; i < 300; ++i) detail.drew(fromSeconds(1e-3 * (2 + 40 * detail.size() * detail.size())));
  EXPECT_EQ(detail.size(), 0.64);
  EXPECT_NEAR(detail.factor(), 2.828, 0.001);  // the relief was made coarser first
  for (int i = 0; i < 500; ++i) detail.drew(fromSeconds(1e-3 * (1 + 10 * detail.size() * detail.size())));
  EXPECT_EQ(detail.size(), 1.0);
  EXPECT_EQ(detail.factor(), 1.0);
}

TEST(DetailLevel, SettlesAndStaysOnASteadyMachine) {
  for (const double fixed_ms : {0.0, 5.0, 11.0, 20.0}) {
    for (const double fine_ms : {5.0, 20.0, 50.0, 200.0}) {
      DetailLevel detail(kBudget);
      run(detail, 20'000, fixed_ms, fine_ms);
      EXPECT_LE(changes(run(detail, 2000, fixed_ms, fine_ms)), 2) << fixed_ms << " ms + " << fine_ms << " ms";
    }
  }
}

TEST(DetailLevel, OneLateFrameChangesNothing) {
  DetailLevel detail(kBudget);
  run(detail, 20, 10.0, 5.0);
  detail.drew(milliseconds(150));
  EXPECT_EQ(changes(run(detail, 20, 10.0, 5.0)), 0);
  EXPECT_EQ(detail.level(), 0);
}

TEST(DetailLevel, TriesAgainMoreAndMoreSeldom) {
  // A machine that is idle while the relief is coarse and busy as soon as it is fine.
  DetailLevel detail(kBudget);
  std::vector<int> levels;
  for (int i = 0; i < 20'000; ++i) {
    detail.drew(detail.level() >= 2 ? milliseconds(5) : milliseconds(30));
    levels.push_back(detail.level());
  }
  // If it always waited 30 frames, there would be an attempt every 30 + 9 frames: over 500 attempts. It waits longer
  // after each failure: 30, 60, .. 3840, 3840, .. frames.
  EXPECT_LT(changes(levels), 40);
  EXPECT_GT(changes(levels), 10);
}

}  // namespace
}  // namespace relievo
