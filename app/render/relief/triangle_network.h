// SPDX-License-Identifier: Apache-2.0
// A right-triangulated irregular network: as few triangles as keep within an error of the lattice's heights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/render/relief/cut_cells.h"
#include "app/render/relief/height_lattice.h"
#include "app/render/relief/output_array.h"

namespace relievo {

// W. Evans, D. Kirkpatrick, G. Townsend, "Right-triangulated irregular networks", Algorithmica 30 (2001): a right
// isosceles triangle is split at the middle of its hypotenuse, both that share it at once, so that no crack opens. Each
// vertex knows the error of leaving it and all that depend on it out; that follows the moving depth with one pass over
// the samples, and nothing of one frame is used in the next.
class TriangleNetwork {
 public:
  struct Triangle {
    std::uint32_t a, b, c;  // places in vertices(), counterclockwise to the viewer
  };

  // From the fine to the coarse. A cut cell is reached by the finest triangles alone, and none of them covers it. Both
  // are looked at again by `triangulate`.
  void measure(const HeightLattice& lattice, const CutCells& cuts);
  // No point of the lattice is farther than `error_mm` from the triangles, along z, but for those of the cut cells.
  void triangulate(float error_mm);

  [[nodiscard]] const OutputArray<Triangle>& triangles() const noexcept { return triangles_; }
  // Of the lattice: the corners of its tiles, and what triangles were split at.
  [[nodiscard]] const OutputArray<std::uint32_t>& vertices() const noexcept { return vertices_; }
  // Of each vertex of the lattice its place in vertices(), counted from 1; 0 where it is not among them.
  [[nodiscard]] const std::vector<std::uint32_t>& slots() const noexcept { return slots_; }

 private:
  void markCuts();
  void measureFinest(const float* z);
  void measureSides(const float* z, int step);
  void measureMiddles(const float* z, int step);
  struct Corner {
    std::uint32_t vertex, place;
  };
  Corner use(std::uint32_t vertex);
  // A triangle can be split so many times, one after the other.
  template <int kDepth>
  void split(Corner a, Corner b, Corner apex);
  template <int kDepth>
  void splitTile(int i, int j);

  const CutCells* cuts_ = nullptr;
  int cols_ = 0, rows_ = 0, tile_ = 1;
  float error_mm_ = 0;
  std::vector<float> errors_;
  OutputArray<Triangle> triangles_;
  OutputArray<std::uint32_t> vertices_;
  std::vector<std::uint32_t> slots_;
  Triangle* next_triangle_ = nullptr;  // while triangulating
  std::uint32_t* next_vertex_ = nullptr;
  std::uint32_t used_ = 0;
};

}  // namespace relievo
