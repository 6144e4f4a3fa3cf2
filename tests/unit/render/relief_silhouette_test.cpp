// SPDX-License-Identifier: Apache-2.0
// Silhouettes of the relief: cut cells, and the far side behind the near one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "app/render/relief/cut_cells.h"
#include "app/render/relief/relief_triangles.h"
#include "app/render/relief/silhouette.h"
#include "app/render/relief/stereo.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/render/drawn_relief.h"

namespace relievo::test {
namespace {

struct Drawn {
  HeightLattice lattice;
  OutputArray<TexturedVertex> vertices;
  OutputArray<std::uint32_t> indices;

  // The heights drawn at a lattice vertex.
  [[nodiscard]] std::vector<double> heightsAt(int c, int r) const {
    std::vector<double> heights;
    for (const TexturedVertex& v : vertices) {
      if (std::abs(v.x - lattice.x(c)) < 1e-4F && std::abs(v.y - lattice.y(r)) < 1e-4F)
        heights.push_back(static_cast<double>(v.z));
    }
    return heights;
  }
  [[nodiscard]] bool isDrawnAt(int c, int r, double z) const {
    const auto all = heightsAt(c, r);
    return std::ranges::any_of(all, [z](double one) { return std::abs(one - z) < 0.01; });
  }
  // The number of triangles that cover a point, borders excluded.
  [[nodiscard]] int timesDrawnAt(float x, float y) const {
    const auto left_of = [&](const TexturedVertex& from, const TexturedVertex& to) {
      return (to.x - from.x) * (y - from.y) - (x - from.x) * (to.y - from.y) > 0;
    };
    int times = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const auto &a = vertices[indices[i]], &b = vertices[indices[i + 1]], &c = vertices[indices[i + 2]];
      if (left_of(a, b) && left_of(b, c) && left_of(c, a)) ++times;
    }
    return times;
  }
};

// One cell, whose top left corner is (c, r).
Drawn drawCell(const HeightMm& height, int c, int r, const ViewSpan& view = {}) {
  Drawn drawn{.lattice = latticeOf(height), .vertices = {}, .indices = {}};
  const auto corner = static_cast<std::uint32_t>(r * drawn.lattice.cols() + c);
  // The surface has one vertex there, on the far side.
  drawn.vertices.add({{{drawn.lattice.x(c), drawn.lattice.y(r), 0, drawn.lattice.u(c), drawn.lattice.v(r)}}});
  std::vector<std::uint32_t> slots(drawn.lattice.size(), 0);
  slots[corner] = 1;
  SilhouetteDrawer(drawn.lattice, view, drawn.vertices, drawn.indices).drawCell(corner, slots);
  return drawn;
}

double step(int c, int /*r*/) {
  return c < kEdge ? 5 : 30;
}

TEST(Silhouette, TheFarSideGoesOnBehindTheNearOne) {
  const Drawn drawn = drawCell(step, kEdge - 1, 10);
  for (const int r : {10, 11}) {
    EXPECT_TRUE(drawn.isDrawnAt(kEdge, r, 30)) << "the near side";
    EXPECT_TRUE(drawn.isDrawnAt(kEdge, r, 5)) << "and the far one behind it";
    EXPECT_FALSE(drawn.isDrawnAt(kEdge - 1, r, 30));
  }
}

// The cell at (kEdge, row) with the given near corners.
Drawn drawCorners(unsigned near, int row) {
  const auto height = [&](int c, int r) {
    const int corner = c == kEdge ? r - row : c == kEdge + 1 ? 3 - (r - row) : -1;
    return r >= row && r <= row + 1 && corner >= 0 && (near >> corner & 1U) != 0 ? 39.0 : 5.0;
  };
  return drawCell(height, kEdge, row);
}

// Bits of the corners, counterclockwise from the top left. High in the picture an eye sees behind objects above, low in
// the picture behind objects below.
class SilhouetteOfCorners : public testing::TestWithParam<std::tuple<unsigned, int>> {};
INSTANTIATE_TEST_SUITE_P(All, SilhouetteOfCorners, testing::Combine(testing::Range(1U, 15U), testing::Values(4, 27)));

TEST_P(SilhouetteOfCorners, DrawsTheNearPartAndAllOfTheFarOneAndOnBehindIt) {
  const auto [near, row] = GetParam();
  const auto is_near = [near](int k) { return (near >> k & 1U) != 0; };
  const Drawn drawn = drawCorners(near, row);
  const auto& lattice = drawn.lattice;
  const float left = lattice.x(kEdge), right = lattice.x(kEdge + 1), top = lattice.y(row), low = lattice.y(row + 1);
  double of_near = 0, of_far = 0;
  for (std::size_t i = 0; i < drawn.indices.size(); i += 3) {
    const auto& a = drawn.vertices[drawn.indices[i]];
    const auto& b = drawn.vertices[drawn.indices[i + 1]];
    const auto& c = drawn.vertices[drawn.indices[i + 2]];
    const double area = 0.5 * static_cast<double>((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
    EXPECT_GT(area, 0) << "counterclockwise to the viewer";
    EXPECT_TRUE(std::abs(a.z - b.z) < 0.01F && std::abs(a.z - c.z) < 0.01F) << "from one thing to the other";
    const float x = (a.x + b.x + c.x) / 3, y = (a.y + b.y + c.y) / 3;
    if (x < left || x > right || y > top || y < low) continue;  // behind what is beside the cell
    (a.z > 20 ? of_near : of_far) += area;
  }
  const double cell = static_cast<double>((right - left) * (top - low));
  const std::array<double, 4> share{0, 1.0 / 8, near == 5 || near == 10 ? 3.0 / 4 : 1.0 / 2, 7.0 / 8};
  EXPECT_NEAR(of_near / cell, share[static_cast<std::size_t>(std::popcount(near))], 1e-4);
  EXPECT_NEAR(of_far / cell, 1, 1e-4);

  const auto any = [&](auto&& beyond) { return std::ranges::any_of(drawn.vertices, beyond); };
  const bool far_left = !is_near(0) && !is_near(1), far_right = !is_near(2) && !is_near(3);
  const bool far_above = !is_near(0) && !is_near(3), far_below = !is_near(1) && !is_near(2);
  EXPECT_EQ(any([&](auto& v) { return v.x > right + 0.1F; }), far_left);
  EXPECT_EQ(any([&](auto& v) { return v.x < left - 0.1F; }), far_right);
  EXPECT_EQ(any([&](auto& v) { return v.y < low - 0.1F; }), far_above && row > kRows / 2);
  EXPECT_EQ(any([&](auto& v) { return v.y > top + 0.1F; }), far_below && row < kRows / 2);

  // The far side takes its colour from further away.
  const int aside_right = (is_near(0) ? -1 : 1) + (is_near(1) ? -1 : 1) - (is_near(2) ? -1 : 1) - (is_near(3) ? -1 : 1);
  const int aside_down = (is_near(1) ? -1 : 1) + (is_near(2) ? -1 : 1) - (is_near(0) ? -1 : 1) - (is_near(3) ? -1 : 1);
  const auto toward = [](int sum) { return static_cast<float>((sum > 0) - (sum < 0)); };
  if (!is_near(0)) {
    EXPECT_NEAR(drawn.vertices[0].u, lattice.u(kEdge) - 1.5F * toward(aside_right) / kCols, 1e-6) << "of the surface";
    EXPECT_NEAR(drawn.vertices[0].v, lattice.v(row) + 1.5F * toward(aside_down) / kRows, 1e-6);
  }
}

TEST_P(SilhouetteOfCorners, WhatGoesOnBehindTheNearPartIsThereOnce) {
  const auto [near, row] = GetParam();
  const Drawn drawn = drawCorners(near, row);
  const auto& lattice = drawn.lattice;
  const float left = lattice.x(kEdge), right = lattice.x(kEdge + 1), top = lattice.y(row), low = lattice.y(row + 1);
  float leftmost = left, rightmost = right, lowest = low, topmost = top;
  for (const TexturedVertex& v : drawn.vertices) {
    leftmost = std::min(leftmost, v.x), rightmost = std::max(rightmost, v.x);
    lowest = std::min(lowest, v.y), topmost = std::max(topmost, v.y);
  }
  for (const float p : {0.1F, 0.6F, 0.85F}) {
    for (const float q : {0.2F, 0.7F}) {
      const float x = std::lerp(left, right, q), y = std::lerp(low, top, q);
      EXPECT_EQ(drawn.timesDrawnAt(std::lerp(right, rightmost, p), y), rightmost > right ? 1 : 0);
      EXPECT_EQ(drawn.timesDrawnAt(std::lerp(left, leftmost, p), y), leftmost < left ? 1 : 0);
      EXPECT_EQ(drawn.timesDrawnAt(x, std::lerp(top, topmost, p)), topmost > top ? 1 : 0);
      EXPECT_EQ(drawn.timesDrawnAt(x, std::lerp(low, lowest, p)), lowest < low ? 1 : 0);
    }
  }
}

TEST(Silhouette, ACornerBelongsToTheSideThatItIsNearerTo) {
  const auto height = [](int c, int r) { return c >= kEdge ? 30.0 : r > 10 ? 12.0 : 5.0; };
  const Drawn drawn = drawCell(height, kEdge - 1, 10);
  EXPECT_TRUE(drawn.isDrawnAt(kEdge, 11, 12)) << "the far side's own slope goes on behind the near one";
  EXPECT_TRUE(drawn.isDrawnAt(kEdge, 10, 5));
}

TEST(Silhouette, BesideTheOutlineTheFarSideShowsWhatIsFartherAway) {
  const Drawn drawn = drawCell(step, kEdge - 1, 10);
  const float aside = drawn.lattice.u(kEdge - 1) - 1.5F / kCols;
  EXPECT_NEAR(drawn.vertices[0].u, aside, 1e-6) << "of the surface";
  for (const TexturedVertex& v : drawn.vertices) {
    const bool is_far = std::abs(v.x - drawn.lattice.x(kEdge - 1)) < 1e-4F;
    EXPECT_NEAR(v.u, is_far ? aside : v.u, 1e-6);
    EXPECT_NEAR(v.v, drawn.lattice.v(v.y > drawn.lattice.y(10) - 1e-4F ? 10 : 11), 1e-6);
  }
}

// Behind an object that rises over several samples, an eye sees as far as over its top.
TEST(Silhouette, ReachesAsFarBehindAsSomeEyeSees) {
  const auto height = [](int c, int /*r*/) { return c < kEdge ? 5.0 : 20.0 + std::min(2 * (c - kEdge), 20); };
  const ViewSpan view;
  const Drawn drawn = drawCell(height, kEdge - 1, 10, view);
  const double top = 20 + 2 * 7;  // the height of the eight samples examined
  const double distance = view.distance_mm + view.screen_z_mm - top;
  const double length = (top - 5) * (static_cast<double>(drawn.lattice.x(kEdge)) + view.eye_mm) / distance;
  double reach = 0;
  for (const TexturedVertex& v : drawn.vertices) {
    if (v.z < 6) reach = std::max(reach, static_cast<double>(v.x));
  }
  EXPECT_NEAR(reach, static_cast<double>(drawn.lattice.x(kEdge)) + length, 0.01);
}

// The far side already extends half a cell behind the outline, which is enough without a strip.
TEST(Silhouette, DrawsNoStripWhereTheCellItselfReachesFarEnough) {
  const auto reach = [](double jump_mm) {
    const Drawn drawn =
        drawCell([=](int c, int /*r*/) { return c < kEdge ? 5.0 : 5.0 + jump_mm; }, kEdge - 1, 10, ViewSpan{});
    double right = -1e9;
    for (const TexturedVertex& v : drawn.vertices) {
      if (v.z < 5.1F) right = std::max(right, static_cast<double>(v.x - drawn.lattice.x(kEdge)));
    }
    return right;
  };
  const Drawn drawn = drawCell(step, kEdge - 1, 10);
  const double half = 0.5 * static_cast<double>(drawn.lattice.x(kEdge) - drawn.lattice.x(kEdge - 1));
  const double per_mm = (static_cast<double>(drawn.lattice.x(kEdge)) + ViewSpan{}.eye_mm) / 600;  // about
  const double enough = half / per_mm;
  EXPECT_NEAR(reach(0.9 * enough), 0, 1e-4);
  EXPECT_GT(reach(1.1 * enough), half);
}

TEST(CutCells, AThinThingIsNoSmear) {
  const auto wire = [](int c, int /*r*/) { return c == 20 ? 30.0 : 5.0; };
  HeightLattice lattice = latticeOf(wire);
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  EXPECT_NEAR(lattice.heights()[20], 30, 0.01);
  EXPECT_EQ(cuts.cells().size(), 2U * (kRows - 1));
}

TEST(CutCells, NothingIsLeftOfAnotherPicture) {
  CutCells cuts;
  HeightLattice wide = latticeOf([](int c, int r) { return (c + r) % 2 == 0 ? 5.0 : 30.0; });
  cuts.find(wide, wide.jumpMm());
  HeightLattice narrow = latticeOf(step, 49, 25);
  cuts.find(narrow, narrow.jumpMm());
  EXPECT_EQ(cuts.cells(), cutsOf(latticeOf(step, 49, 25)));
  for (int r = 0; r + 1 < narrow.rows(); ++r) {
    EXPECT_FALSE(cuts.contains(static_cast<std::size_t>(r + 1) * narrow.cols() - 1)) << "right of the picture";
  }
}

}  // namespace
}  // namespace relievo::test
