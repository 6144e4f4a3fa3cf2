// SPDX-License-Identifier: Apache-2.0
// The triangulation against its definition: no point inside any circumcircle, and the whole rectangle covered.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "app/enhance/delaunay.h"

namespace relievo {
namespace {

using Point = Delaunay::Point;

// Any triangle that contains the point, borders included, by trying them all.
int holderOf(const Delaunay& mesh, const Point& p) {
  const auto& points = mesh.points();
  for (std::size_t t = 0; t < mesh.triangles().size(); ++t) {
    const auto [a, b, c] = mesh.triangles()[t];
    if (std::min({turn(points[a], points[b], p), turn(points[b], points[c], p), turn(points[c], points[a], p)}) >= 0) {
      return static_cast<int>(t);
    }
  }
  return -1;
}

void expectDelaunay(const Delaunay& mesh, int right, int bottom) {
  const auto& points = mesh.points();
  std::int64_t twice_area = 0;
  for (const auto& [a, b, c] : mesh.triangles()) {
    const std::int64_t area = turn(points[a], points[b], points[c]);
    EXPECT_GT(area, 0);
    twice_area += area;
    for (const Point& p : points) EXPECT_LE(insideCircle(points[a], points[b], points[c], p), 0);
  }
  EXPECT_EQ(twice_area, 2LL * right * bottom);
  const auto rim = std::count_if(points.begin(), points.end(),
                                 [&](const Point& p) { return p.x == 0 || p.y == 0 || p.x == right || p.y == bottom; });
  EXPECT_EQ(mesh.triangles().size(), 2 * points.size() - 2 - static_cast<std::size_t>(rim));  // Euler
}

// All points of a small grid: each square's corners lie on one circle, each row on one line, many points on the border.
TEST(EnhanceDelaunay, TakesAWholeGridInAnyOrder) {
  constexpr int kRight = 8, kBottom = 5;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::vector<Point> rest;
    for (int y = 0; y <= kBottom; ++y) {
      for (int x = 0; x <= kRight; ++x) {
        if ((x != 0 && x != kRight) || (y != 0 && y != kBottom)) rest.push_back({x, y});
      }
    }
    std::shuffle(rest.begin(), rest.end(), std::mt19937(seed));
    Delaunay mesh(kRight, kBottom);
    for (const Point& p : rest) {
      const int holder = holderOf(mesh, p);
      ASSERT_GE(holder, 0);
      static_cast<void>(mesh.insert(p, holder));
    }
    expectDelaunay(mesh, kRight, kBottom);
  }
}

TEST(EnhanceDelaunay, HoldsForScatteredPointsAndTellsWhichTrianglesChanged) {
  constexpr int kRight = 719, kBottom = 485;
  std::mt19937 random(7);
  std::uniform_int_distribution<int> x(1, kRight - 1), y(1, kBottom - 1);
  Delaunay mesh(kRight, kBottom);
  std::set<std::pair<int, int>> taken;
  for (int i = 0; i < 150; ++i) {
    const Point p{x(random), y(random)};
    if (!taken.insert({p.x, p.y}).second) continue;
    const auto before = mesh.triangles();
    const auto told = mesh.insert(p, holderOf(mesh, p));
    const std::set<int> changed(told.begin(), told.end());
    EXPECT_EQ(changed.size(), told.size()) << "each once";
    for (std::size_t t = 0; t < mesh.triangles().size(); ++t) {
      const bool differs = t >= before.size() || before[t] != mesh.triangles()[t];
      EXPECT_EQ(differs, changed.contains(static_cast<int>(t))) << t;
    }
  }
  expectDelaunay(mesh, kRight, kBottom);
}

// On the largest picture: a point on the circle through three corners of a square, and those one sample beside it.
TEST(EnhanceDelaunay, IsExactWhereCoordinatesAreLargest) {
  constexpr int kEnd = 16383;
  const Point a{0, 0}, b{kEnd, 0}, c{kEnd, kEnd};
  EXPECT_EQ(insideCircle(a, b, c, {0, kEnd}), 0);
  EXPECT_GT(insideCircle(a, b, c, {1, kEnd}), 0);
  EXPECT_GT(insideCircle(a, b, c, {0, kEnd - 1}), 0);
  EXPECT_LT(insideCircle(a, b, c, {-1, kEnd}), 0);
}

}  // namespace
}  // namespace relievo
