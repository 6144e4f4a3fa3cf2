// SPDX-License-Identifier: Apache-2.0
// The mesh of a depth picture: within its bound at every sample, with few points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/enhance/depth_mesh.h"
#include "tests/support/film/depth_map.h"
#include "tests/support/film/real_depth.h"

namespace relievo {
namespace {

using test::mapOf;

// The largest error of the triangles' planes at any known sample, by barycentric coordinates.
double mostOff(const DepthMesh& mesh, const DepthMap& map) {
  double most = 0;
  std::vector<char> covered(map.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto &pa = mesh.points[a], &pb = mesh.points[b], &pc = mesh.points[c];
    const auto [left, right] = std::minmax({pa.x, pb.x, pc.x});
    const auto [top, bottom] = std::minmax({pa.y, pb.y, pc.y});
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const auto of_a = turn(pb, pc, {x, y}), of_b = turn(pc, pa, {x, y}), of_c = turn(pa, pb, {x, y});
        if (std::min({of_a, of_b, of_c}) < 0) continue;
        covered[map.at(x, y)] = 1;
        if (map.holes[map.at(x, y)] != 0) continue;
        const auto share = [&](std::int64_t area, int corner) {
          return static_cast<double>(area) * static_cast<double>(mesh.codes[corner]);
        };
        const double sum = share(of_a, a) + share(of_b, b) + share(of_c, c);
        const auto known = static_cast<double>(map.codes[map.at(x, y)]);
        most = std::max(most, std::abs(sum / static_cast<double>(turn(pa, pb, pc)) - known));
      }
    }
  }
  EXPECT_EQ(std::count(covered.begin(), covered.end(), 0), 0);
  return most;
}

TEST(EnhanceMesh, APlaneTakesFourPoints) {
  const auto plane = mapOf(160, 120, [](int c, int r) { return 1000 + 37.25 * c + 81.5 * r; });
  EXPECT_EQ(meshOf(plane, 1).points.size(), 4u);
  EXPECT_LT(mostOff(meshOf(plane, 1), plane), 0.05);
}

// Rounding shifts a corner and a sample by half a step each, at most one step relative to each other.
TEST(EnhanceMesh, APlaneInEightBitsTakesFourPointsWithinAStep) {
  const auto plane = mapOf(160, 120, [](int c, int r) { return 257 * std::round(20 + 0.31 * c + 0.17 * r); });
  EXPECT_EQ(meshOf(plane, 1.001F * DepthMap::kLevel).points.size(), 4u);
  EXPECT_GT(meshOf(plane, 0.25F * DepthMap::kLevel).points.size(), 100u);
}

TEST(EnhanceMesh, HoldsItsBoundOnAnySurface) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int round = 0; round < 12; ++round) {
    const double wave = 0.05 + 0.3 * share(random), height = 8000 * share(random), edge = 30 + 40 * share(random),
                 slant = share(random) - 0.5, roughness = round % 3 == 0 ? 300 : 0;
    auto map = mapOf(97, 71, [&](int c, int r) {
      const double step = c < edge + slant * r ? 20000 : 0;
      return 20000 + step + height * std::sin(wave * c) * std::cos(wave * r) + roughness * share(random);
    });
    for (int i = 0; i < 300; ++i) {
      const auto at = static_cast<std::size_t>(share(random) * static_cast<double>(map.size() - 1));
      map.holes[at] = 1;
      map.codes[at] = 0;
    }
    std::size_t before = map.size() + 1;
    for (const float bound : {50.0F, 200.0F, 1000.0F}) {
      const DepthMesh mesh = meshOf(map, bound);
      EXPECT_LE(mostOff(mesh, map), static_cast<double>(bound) + 0.1);
      EXPECT_LE(mesh.points.size(), before) << "a wider bound takes no more";
      before = mesh.points.size();
    }
  }
}

// Every sample is reproduced with at most two points per row.
TEST(EnhanceMesh, KeepsAStep) {
  const auto upright = mapOf(80, 60, [](int c, int) { return c < 33 ? 50000 : 9000; });
  EXPECT_LE(meshOf(upright, 100).points.size(), 4u + 2 * 60);
  EXPECT_LT(mostOff(meshOf(upright, 100), upright), 0.1);
  const auto round = mapOf(80, 60, [](int c, int r) { return std::hypot(c - 40, r - 30) < 20 ? 50000 : 9000; });
  EXPECT_LT(mostOff(meshOf(round, 100), round), 100.1);
}

TEST(EnhanceMesh, HolesAskForNothingAndStay) {
  auto map = mapOf(80, 60, [](int c, int r) { return 30000 + 100 * c + 10 * r; });
  for (int r = 0; r < 30; ++r) {
    for (int c = 0; c < 50; ++c) {  // a corner of the picture among them
      map.holes[map.at(c, r)] = 1;
      map.codes[map.at(c, r)] = 0;
    }
  }
  const DepthMesh mesh = meshOf(map, 20);
  EXPECT_LE(mostOff(mesh, map), 20.1);
  EXPECT_LT(mesh.points.size(), 40u) << "the corner that nobody knows costs a few";
  renderMesh(mesh, map);
  EXPECT_EQ(map.codes[0], 0);
}

// By barycentric coordinates here as well.
TEST(EnhanceMesh, IsRenderedAtEverySample) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> any(0, 60000);
  const auto rough = mapOf(23, 17, [&](int, int) { return any(random); });
  const DepthMesh mesh = meshOf(rough, 20000);
  auto rendered = mapOf(23, 17, [](int, int) { return -1e6; });
  renderMesh(mesh, rendered);
  EXPECT_LT(mostOff(mesh, rendered), 0.1);
}

TEST(EnhanceMesh, TakesTheSmallestPictures) {
  EXPECT_TRUE(meshOf(mapOf(1, 1, [](int, int) { return 5; }), 1).points.empty());
  EXPECT_TRUE(meshOf(mapOf(9, 1, [](int c, int) { return c; }), 1).points.empty());
  EXPECT_TRUE(meshOf(mapOf(1, 9, [](int, int r) { return r; }), 1).points.empty());
  const auto four = mapOf(2, 2, [](int c, int r) { return 100 * c + 7000 * r * c; });
  EXPECT_EQ(meshOf(four, 1).points.size(), 4u);
  EXPECT_LT(mostOff(meshOf(four, 1), four), 0.1);
  auto none = four;
  none.holes.assign(4, 1);
  EXPECT_TRUE(meshOf(none, 1).points.empty());
}

// A still life with measured disparity: the number of points follows the bound, far below the number of samples.
TEST(EnhanceMesh, TakesOfARealSceneWhatItsBoundAsksFor) {
  const auto cones = test::readCones(RELIEVO_TEST_DATA);
  if (!cones) GTEST_SKIP() << "no real depth video at " RELIEVO_TEST_DATA;
  const auto map = readDepth(test::depthOf(*cones), {.bits = 16, .invalid = 0}).value();
  std::size_t before = map.size();
  for (const float levels : {0.5F, 1.0F, 2.0F, 4.0F}) {
    const DepthMesh mesh = meshOf(map, levels * DepthMap::kLevel);
    EXPECT_LE(mostOff(mesh, map), static_cast<double>(levels * DepthMap::kLevel) + 0.1);
    EXPECT_LT(mesh.points.size(), before);
    before = mesh.points.size();
    RecordProperty("points", static_cast<int>(before));
  }
  EXPECT_LT(before, map.size() / 10);
}

}  // namespace
}  // namespace relievo
