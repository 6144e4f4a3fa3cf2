// SPDX-License-Identifier: Apache-2.0
// The relief of a still life whose true shape was measured: cut at the edges of its objects and nowhere else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "app/render/relief/cut_cells.h"
#include "app/render/relief/height_lattice.h"
#include "app/render/relief/triangle_network.h"
#include "tests/support/film/real_depth.h"

namespace relievo {
namespace {

using test::Disparity;

constexpr int kAcross = 1024;  // more than the picture has: every sample is a vertex

class Cones : public testing::Test {
 protected:
  void SetUp() override {
    disparity_ = test::readCones(RELIEVO_TEST_DATA);
    if (!disparity_) GTEST_SKIP() << "no real depth video at " RELIEVO_TEST_DATA;
    depth_ = test::depthOf(*disparity_);
    field_ = HeightField::make(depth_, {.bits = 16, .invalid = 0}, volume_).value();
    lattice_.read(field_, kAcross);
    cuts_.find(lattice_, lattice_.jumpMm());
  }
  [[nodiscard]] float disparityAt(int i, int j) const { return disparity_->at(lattice_.column(i), lattice_.row(j)); }
  // Whether the vertex was moved away from its measured height, as a smeared sample between two objects is.
  [[nodiscard]] bool isMoved(int i, int j) const {
    const double measured_mm = static_cast<double>(disparityAt(i, j) / Disparity::kMost) * volume_.depth_mm;
    const float stands_mm = lattice_.heights()[static_cast<std::size_t>(j) * lattice_.cols() + i];
    return std::abs(static_cast<double>(stands_mm) - measured_mm) > 0.01;
  }
  // Whether the measurement has an object's edge between two adjacent vertices.
  [[nodiscard]] bool trueJump(int i, int j, int right, int down, float pixels) const {
    const float here = disparityAt(i, j), there = disparityAt(i + right, j + down);
    return here > 0 && there > 0 && std::abs(here - there) > pixels;
  }
  [[nodiscard]] float jumpPixels() const {
    return lattice_.jumpMm() / static_cast<float>(volume_.depth_mm) * Disparity::kMost;
  }

  const DisplayVolume volume_ = DisplayVolume::forPicture(Disparity::kCols, Disparity::kRows);
  std::optional<Disparity> disparity_;
  Frame depth_;
  HeightField field_;
  HeightLattice lattice_;
  CutCells cuts_;
};

TEST_F(Cones, NoTriangleLiesAcrossATrueSilhouette) {
  TriangleNetwork network;
  network.measure(lattice_, cuts_);
  network.triangulate(0.5F);
  const int cols = lattice_.cols();
  // 1 % more than a jump, because the depth picture's codes are rounded.
  const float jump = 1.01F * jumpPixels();
  EXPECT_LT(jump, 3) << "of 55";
  int across = 0;
  const auto& vertices = network.vertices();
  for (const auto& places : network.triangles()) {
    const TriangleNetwork::Triangle triangle{vertices[places.a], vertices[places.b], vertices[places.c]};
    const int ai = static_cast<int>(triangle.a) % cols, aj = static_cast<int>(triangle.a) / cols;
    const int bi = static_cast<int>(triangle.b) % cols, bj = static_cast<int>(triangle.b) / cols;
    const int ci = static_cast<int>(triangle.c) % cols, cj = static_cast<int>(triangle.c) / cols;
    const auto inside = [&](int i, int j) {
      const auto side = [&](int pi, int pj, int qi, int qj) { return (qi - pi) * (j - pj) - (qj - pj) * (i - pi); };
      return std::max({side(ai, aj, bi, bj), side(bi, bj, ci, cj), side(ci, cj, ai, aj)}) <= 0;
    };
    const auto [left, right] = std::minmax({ai, bi, ci});
    const auto [top, bottom] = std::minmax({aj, bj, cj});
    bool crosses = false;
    for (int j = top; j <= bottom; ++j) {
      for (int i = left; i <= right; ++i) {
        if (!inside(i, j)) continue;
        for (const auto& [east, south] : {std::pair{1, 0}, {0, 1}}) {
          if (!inside(i + east, j + south) || isMoved(i, j) || isMoved(i + east, j + south)) continue;
          crosses = crosses || trueJump(i, j, east, south, jump);
        }
      }
    }
    across += crosses ? 1 : 0;
  }
  EXPECT_EQ(across, 0) << "of " << network.triangles().size();
  EXPECT_GT(network.triangles().size(), 10'000U);
}

TEST_F(Cones, HardlyASampleIsMoved) {
  int moved = 0, known = 0;
  for (int j = 0; j < lattice_.rows(); ++j) {
    for (int i = 0; i < lattice_.cols(); ++i) {
      if (disparityAt(i, j) == 0) continue;
      ++known;
      moved += isMoved(i, j) ? 1 : 0;
    }
  }
  EXPECT_LT(moved, known / 500);
}

// Every cut cell has a true jump at one of its sides, or a corner without a measurement.
TEST_F(Cones, IsCutAtTrueSilhouettesAlone) {
  const int cols = lattice_.cols();
  int without_reason = 0;
  for (const std::uint32_t cell : cuts_.cells()) {
    const int i = static_cast<int>(cell) % cols, j = static_cast<int>(cell) / cols;
    const float least = 0.99F * jumpPixels();
    const bool jump = trueJump(i, j, 1, 0, least) || trueJump(i, j + 1, 1, 0, least) || trueJump(i, j, 0, 1, least) ||
                      trueJump(i + 1, j, 0, 1, least);
    const bool unknown = disparityAt(i, j) == 0 || disparityAt(i + 1, j) == 0 || disparityAt(i, j + 1) == 0 ||
                         disparityAt(i + 1, j + 1) == 0;
    without_reason += jump || unknown ? 0 : 1;
  }
  EXPECT_GT(cuts_.cells().size(), 2000U);
  EXPECT_EQ(without_reason, 0) << "of " << cuts_.cells().size();
}

}  // namespace
}  // namespace relievo
