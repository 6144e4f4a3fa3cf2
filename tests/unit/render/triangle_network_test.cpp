// SPDX-License-Identifier: Apache-2.0
// The irregular network against its heights: complete, without cracks, and within its error.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "app/render/relief/triangle_network.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/render/network_fit.h"

namespace relievo::test {
namespace {

TriangleNetwork::Triangle onLattice(const TriangleNetwork& network, const TriangleNetwork::Triangle& places) {
  const auto& vertices = network.vertices();
  return {vertices[places.a], vertices[places.b], vertices[places.c]};
}

// The largest distance along z between a triangle and the lattice's points in it; how often each point lies inside or
// on the border of one.
struct Fit {
  double worst_mm = 0;
  std::vector<int> covered;
};
Fit fitOf(const HeightLattice& lattice, const TriangleNetwork& network) {
  Fit fit;
  fit.covered.assign(lattice.size(), 0);
  const auto z = [&](std::size_t vertex) { return static_cast<double>(lattice.heights()[vertex]); };
  for (const auto& places : network.triangles()) {
    const auto triangle = onLattice(network, places);
    const Point a = at(lattice, triangle.a), b = at(lattice, triangle.b), c = at(lattice, triangle.c);
    const int whole = area(a, b, c);
    EXPECT_LT(whole, 0) << "turned over";
    for (int j = std::min({a.j, b.j, c.j}); j <= std::max({a.j, b.j, c.j}); ++j) {
      for (int i = std::min({a.i, b.i, c.i}); i <= std::max({a.i, b.i, c.i}); ++i) {
        const Point p{i, j};
        const int of_a = area(p, b, c), of_b = area(a, p, c), of_c = area(a, b, p);
        if (std::max({of_a, of_b, of_c}) > 0) continue;
        const std::size_t here = static_cast<std::size_t>(j) * lattice.cols() + i;
        ++fit.covered[here];
        const double plane = (of_a * z(triangle.a) + of_b * z(triangle.b) + of_c * z(triangle.c)) / whole;
        fit.worst_mm = std::max(fit.worst_mm, std::abs(plane - z(here)));
      }
    }
  }
  return fit;
}

// Every side belongs to two triangles with opposite directions, except on the lattice's border: no vertex lies in the
// middle of another triangle's side.
int openSides(const HeightLattice& lattice, const TriangleNetwork& network) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& places : network.triangles()) {
    const auto [a, b, c] = onLattice(network, places);
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) ++sides[{from, to}];
  }
  int open = 0;
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    const Point from = at(lattice, side.first), to = at(lattice, side.second);
    const bool border = (from.i == to.i && (from.i == 0 || from.i == lattice.cols() - 1)) ||
                        (from.j == to.j && (from.j == 0 || from.j == lattice.rows() - 1));
    if (!border && !sides.contains({side.second, side.first})) ++open;
  }
  return open;
}

TriangleNetwork networkOf(HeightLattice lattice, double error_mm) {
  CutCells cuts;
  cuts.find(lattice, kNoJump);
  TriangleNetwork network;
  network.measure(lattice, cuts);
  network.triangulate(static_cast<float>(error_mm));
  return network;
}

// Cut and finer, then whole and coarser, then another size and back.
TEST(TriangleNetwork, NothingIsLeftOfAnotherPicture) {
  const Height step = [](double x, double y) { return wave(x, y) + (x > 0.3 * y ? 9 : 0); };
  const std::array lattices{latticeOf(129, 65, step), latticeOf(129, 65, wave), latticeOf(65, 129, wave),
                            latticeOf(97, 33, step), latticeOf(129, 65, step)};
  TriangleNetwork network;
  float error_mm = 0.05F;
  for (HeightLattice lattice : lattices) {
    CutCells cuts;
    cuts.find(lattice, lattice.jumpMm());
    TriangleNetwork fresh;
    for (TriangleNetwork* each : {&network, &fresh}) {
      each->measure(lattice, cuts);
      each->triangulate(error_mm);
    }
    EXPECT_TRUE(std::ranges::equal(network.vertices(), fresh.vertices()));
    EXPECT_TRUE(std::ranges::equal(network.triangles(), fresh.triangles(), [](const auto& a, const auto& b) {
      return a.a == b.a && a.b == b.b && a.c == b.c;
    }));
    EXPECT_EQ(network.slots(), fresh.slots());
    error_mm *= 1.5F;
  }
}

TEST(TriangleNetwork, PlaneTakesTwoTrianglesATile) {
  const HeightLattice lattice = latticeOf(129, 65, [](double x, double y) { return 20 + 0.1 * x - 0.05 * y; });
  ASSERT_EQ(lattice.tile(), 32);
  EXPECT_EQ(networkOf(lattice, 0.01).triangles().size(), 2U * 4 * 2);
}

TEST(TriangleNetwork, KeepsWithinItsErrorEverywhere) {
  for (const auto& [cols, rows] : {std::pair{129, 65}, {200, 131}, {97, 33}, {720, 486}}) {
    const HeightLattice lattice = latticeOf(cols, rows, wave);
    for (const double error_mm : {2.0, 0.5, 0.1, 0.02}) {
      const Fit fit = fitOf(lattice, networkOf(lattice, error_mm));
      EXPECT_LE(fit.worst_mm, error_mm + 1e-4) << cols << " x " << rows;
      EXPECT_GT(fit.worst_mm, 0.02 * error_mm) << "a bound that is far from the truth";
    }
  }
}

TEST(TriangleNetwork, KeepsWithinItsErrorOnNoise) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(0, 4);
  const HeightLattice lattice = latticeOf(129, 65, [&](double x, double y) { return wave(x, y) + noise(random); });
  for (const double error_mm : {8.0, 3.0, 1.0}) {
    EXPECT_LE(fitOf(lattice, networkOf(lattice, error_mm)).worst_mm, error_mm + 1e-4);
  }
}

TEST(TriangleNetwork, CoversEveryPointWithoutCracks) {
  for (const double error_mm : {2.0, 0.3, 0.03}) {
    const HeightLattice lattice = latticeOf(200, 131, wave);
    const TriangleNetwork network = networkOf(lattice, error_mm);
    const Fit fit = fitOf(lattice, network);
    EXPECT_EQ(std::count(fit.covered.begin(), fit.covered.end(), 0), 0);
    EXPECT_EQ(openSides(lattice, network), 0);
    int twice_area = 0;
    for (const auto& places : network.triangles()) {
      const auto [a, b, c] = onLattice(network, places);
      twice_area -= area(at(lattice, a), at(lattice, b), at(lattice, c));
    }
    EXPECT_EQ(twice_area, 2 * (lattice.cols() - 1) * (lattice.rows() - 1));
  }
}

TEST(TriangleNetwork, FinerErrorTakesMoreTriangles) {
  const HeightLattice lattice = latticeOf(720, 486, wave);
  std::size_t before = 0;
  for (const double error_mm : {2.0, 0.5, 0.1, 0.02}) {
    const std::size_t count = networkOf(lattice, error_mm).triangles().size();
    EXPECT_GT(count, before);
    before = count;
  }
  EXPECT_LT(networkOf(lattice, 0.5).triangles().size(), 2U * 719 * 485 / 50);
}

// A disc 20 mm above its ground: no triangle has corners on both, and the gaps between the triangles are exactly the
// cells between the two.
TEST(TriangleNetwork, NoTriangleLiesAcrossASilhouette) {
  const auto on_disc = [](double x, double y) { return std::hypot(x - 10, y + 5) < 31; };
  HeightLattice lattice =
      latticeOf(257, 161, [&](double x, double y) { return (on_disc(x, y) ? 25.0 : 5.0) + 0.02 * x; });
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  TriangleNetwork network;
  network.measure(lattice, cuts);
  network.triangulate(0.5F);
  const auto isHigh = [&](std::uint32_t vertex) { return lattice.heights()[vertex] > 15; };
  for (const auto& places : network.triangles()) {
    const auto [a, b, c] = onLattice(network, places);
    ASSERT_EQ(isHigh(a), isHigh(b));
    ASSERT_EQ(isHigh(b), isHigh(c));
  }
  EXPECT_LE(fitOf(lattice, network).worst_mm, 0.5);
  int twice_area = 0;
  for (const auto& places : network.triangles()) {
    const auto [a, b, c] = onLattice(network, places);
    twice_area -= area(at(lattice, a), at(lattice, b), at(lattice, c));
  }
  const auto cut = static_cast<int>(cuts.cells().size());
  EXPECT_EQ(twice_area, 2 * ((lattice.cols() - 1) * (lattice.rows() - 1) - cut));
  EXPECT_GT(cut, 200);
  for (const std::uint32_t cell : cuts.cells()) {
    const auto width = static_cast<std::uint32_t>(lattice.cols());
    const int high = isHigh(cell) + isHigh(cell + 1) + isHigh(cell + width) + isHigh(cell + width + 1);
    EXPECT_TRUE(high > 0 && high < 4);
  }
}

}  // namespace
}  // namespace relievo::test
