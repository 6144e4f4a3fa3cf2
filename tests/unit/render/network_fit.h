// SPDX-License-Identifier: Apache-2.0
// Waves as height lattices, and how a network of triangles fits them.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include "app/render/relief/triangle_network.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

using Height = std::function<double(double x, double y)>;

inline constexpr DisplayVolume kVolume{160.0, 108.0, 40.0};
inline constexpr float kNoJump = 1000.0F;

inline double wave(double x, double y) {
  return 20 + 8 * std::sin(0.11 * x) * std::cos(0.09 * y) + 0.05 * x;
}

inline HeightLattice latticeOf(int cols, int rows, const Height& height, int most_across = 4096) {
  const Frame frame = makeReliefFrame(cols, rows, kVolume, MediaTime{}, height);
  HeightLattice lattice;
  lattice.read(HeightField::make(frame, {.bits = 16}, kVolume).value(), most_across);
  return lattice;
}

struct Point {
  int i, j;
};
inline Point at(const HeightLattice& lattice, std::uint32_t vertex) {
  return {static_cast<int>(vertex) % lattice.cols(), static_cast<int>(vertex) / lattice.cols()};
}

// Twice the signed area in cells, y down: negative if it is counterclockwise for the viewer.
inline int area(Point a, Point b, Point c) {
  return (b.i - a.i) * (c.j - a.j) - (c.i - a.i) * (b.j - a.j);
}

}  // namespace relievo::test
