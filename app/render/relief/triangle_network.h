// SPDX-License-Identifier: Apache-2.0
// A right-triangulated irregular network: few triangles that stay within an error of the lattice's heights.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/render/relief/cut_cells.h"
#include "app/render/relief/height_lattice.h"
#include "app/render/relief/output_array.h"

namespace relievo {

// W. Evans, D. Kirkpatrick, G. Townsend, "Right-triangulated irregular networks", Algorithmica 30 (2001): a right
// isosceles triangle is split at the midpoint of its hypotenuse, together with the other triangle that shares it, so
// that no crack opens. For each vertex the error of omitting it and its dependents is computed anew for each frame in
// one pass over the samples.
class TriangleNetwork {
 public:
  struct Triangle {
    std::uint32_t a, b, c;  // indices into vertices(), counterclockwise for the viewer
  };

  // Computes all errors. A cut cell is reached only by the finest triangles, and none of them covers it. `cuts` must
  // outlive the following `triangulate`.
  void measure(const HeightLattice& lattice, const CutCells& cuts);
  // Every lattice point is within `error_mm` of the triangles along z, except those of cut cells.
  void triangulate(float error_mm);

  [[nodiscard]] const OutputArray<Triangle>& triangles() const noexcept { return triangles_; }
  // Lattice indices: the corners of its tiles, and the split points of triangles.
  [[nodiscard]] const OutputArray<std::uint32_t>& vertices() const noexcept { return vertices_; }
  // For each lattice vertex its index in vertices() plus 1; 0 if it is not in the list.
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
  // kDepth: how many more times a triangle can be split.
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
