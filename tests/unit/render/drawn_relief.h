// SPDX-License-Identifier: Apache-2.0
// Reliefs made of heights, and the triangles that are drawn of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "app/render/relief/cut_cells.h"
#include "app/render/relief/height_lattice.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

using HeightMm = std::function<double(int c, int r)>;

inline constexpr DisplayVolume kVolume{160.0, 80.0, 40.0};
inline constexpr int kCols = 65, kRows = 33;  // two tiles of 32 cells and one: every sample is a vertex, once
inline constexpr double kHole = -1;
inline constexpr int kEdge = 33;  // the first near column

inline Frame frameOf(const HeightMm& height, int cols = kCols, int rows = kRows) {
  return makeGrayFrame(cols, rows, 16, MediaTime{}, [&](int c, int r) {
    const double z = height(c, r);
    return z == kHole ? 0U : static_cast<std::uint32_t>(1 + std::lround(z / 40 * 65534));
  });
}
inline HeightField fieldOf(const Frame& frame) {
  return HeightField::make(frame, {.bits = 16, .invalid = 0}, kVolume).value();
}
inline HeightLattice latticeOf(const HeightMm& height, int cols = kCols, int rows = kRows) {
  const Frame frame = frameOf(height, cols, rows);
  HeightLattice lattice;
  lattice.read(fieldOf(frame), 4096);
  return lattice;
}
inline std::vector<std::uint32_t> cutsOf(HeightLattice lattice) {
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  return cuts.cells();
}

}  // namespace relievo::test
