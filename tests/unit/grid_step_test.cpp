// SPDX-License-Identifier: Apache-2.0
// The mesh keeps within its frame budget, on made-up drawing times.
#include "app/render/grid_step.h"

#include <gtest/gtest.h>

#include <vector>

namespace relievo {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr int kCols = 720;
constexpr int kRows = 486;

// A renderer that takes `fixed` and so much for each vertex. Returns the step after each frame.
std::vector<int> run(GridStep& grid, int frames, double fixed_ms, double us_per_vertex, int cols = kCols,
                     int rows = kRows) {
  std::vector<int> steps;
  for (int i = 0; i < frames; ++i) {
    const double vertices =
        static_cast<double>(GridStep::verticesAlong(cols, grid.step())) * GridStep::verticesAlong(rows, grid.step());
    grid.drew(fromSeconds(1e-3 * fixed_ms + 1e-6 * us_per_vertex * vertices));
    steps.push_back(grid.step());
  }
  return steps;
}

int changes(const std::vector<int>& steps) {
  int count = 0;
  for (std::size_t i = 1; i < steps.size(); ++i) count += steps[i] != steps[i - 1];
  return count;
}

TEST(GridStep, VerticesReachTheLastSample) {
  // 0 4 8, and 9; 0 4 8; one.
  EXPECT_EQ(GridStep::verticesAlong(10, 4), 4);
  EXPECT_EQ(GridStep::verticesAlong(9, 4), 3);
  EXPECT_EQ(GridStep::verticesAlong(1, 4), 1);
  EXPECT_EQ(GridStep::verticesAlong(720, 1), 720);
}

TEST(GridStep, BeginsWithWhatSoftwareCanDraw) {
  GridStep grid(milliseconds(33));
  grid.setGrid(kCols, kRows);
  EXPECT_EQ(grid.step(), 4);  // 181 x 123 = 22263 vertices; at 3 there would be 241 x 163
  grid.setGrid(160, 90);
  EXPECT_EQ(grid.step(), 1);
}

TEST(GridStep, GoesCoarserUntilTheBudgetHolds) {
  GridStep grid(milliseconds(33));
  grid.setGrid(kCols, kRows);
  // 8 ms and 2 us a vertex: 22263 take 52.5 ms, 145 x 98 36.4 ms, 121 x 82 27.8 ms.
  run(grid, 100, 8.0, 2.0);
  EXPECT_EQ(grid.step(), 6);
}

TEST(GridStep, GoesFinerOnlyAsFarAsIsSureToHold) {
  GridStep grid(milliseconds(33));
  grid.setGrid(kCols, kRows);
  // 5 ms and 0.2 us a vertex. Step 4 takes 9.5 ms: step 3 at most 9.5 * 39283/22263 = 16.7. Step 3 takes 12.9 ms:
  // step 2 at most 12.9 * 88084/39283 = 28.8, more than four fifths of the budget.
  run(grid, 300, 5.0, 0.2);
  EXPECT_EQ(grid.step(), 3);
}

TEST(GridStep, TakesEveryVertexWhereThereIsRoom) {
  GridStep grid(milliseconds(33));
  grid.setGrid(kCols, kRows);
  run(grid, 300, 0.5, 0.01);
  EXPECT_EQ(grid.step(), 1);
}

TEST(GridStep, SettlesAndStaysOnASteadyMachine) {
  for (const double fixed_ms : {0.0, 5.0, 15.0, 25.0}) {
    for (const double us_per_vertex : {0.05, 0.2, 0.5, 1.0, 3.0}) {
      GridStep grid(milliseconds(33));
      grid.setGrid(kCols, kRows);
      run(grid, 400, fixed_ms, us_per_vertex);
      EXPECT_EQ(changes(run(grid, 2000, fixed_ms, us_per_vertex)), 0) << fixed_ms << " ms + " << us_per_vertex << " us";
    }
  }
}

TEST(GridStep, OneLateFrameChangesNothing) {
  GridStep grid(milliseconds(33));
  grid.setGrid(kCols, kRows);
  run(grid, 20, 10.0, 0.5);
  grid.drew(milliseconds(150));
  EXPECT_EQ(changes(run(grid, 20, 10.0, 0.5)), 0);
  EXPECT_EQ(grid.step(), 4);
}

TEST(GridStep, TriesAgainMoreAndMoreSeldom) {
  // A machine that is idle while the grid is coarse and busy as soon as it is fine.
  GridStep grid(milliseconds(33));
  grid.setGrid(kCols, kRows);
  std::vector<int> steps;
  for (int i = 0; i < 20'000; ++i) {
    grid.drew(grid.step() >= 4 ? milliseconds(10) : milliseconds(40));
    steps.push_back(grid.step());
  }
  // Without patience there would be a try each 30 + 9 frames: over 500. With it 30, 60, .. 3840, 3840, ..
  EXPECT_LT(changes(steps), 30);
  EXPECT_GT(changes(steps), 10);
}

TEST(GridStep, StopsWhereCoarserHelpsNoMore) {
  GridStep grid(milliseconds(33));
  grid.setGrid(kCols, kRows);
  run(grid, 1000, 100.0, 0.5);
  // At step 8 there are 91 x 62 = 5642 vertices, at 9 81 x 55 = 4455, under 5000.
  EXPECT_EQ(grid.step(), 8);
}

TEST(GridStep, StartsAnewForAnotherSize) {
  GridStep grid(milliseconds(33));
  grid.setGrid(kCols, kRows);
  run(grid, 100, 8.0, 2.0);
  ASSERT_NE(grid.step(), 4);
  grid.setGrid(kCols, kRows);
  EXPECT_NE(grid.step(), 4);  // the same size: what was learnt is kept
  grid.setGrid(kCols + 1, kRows);
  EXPECT_EQ(grid.step(), 4);
}

}  // namespace
}  // namespace relievo
