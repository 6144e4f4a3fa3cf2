// SPDX-License-Identifier: Apache-2.0
// Computes vertex errors from fine to coarse, and triangles from coarse to fine.
#include "app/render/relief/triangle_network.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace relievo {

void TriangleNetwork::measure(const HeightLattice& lattice, const CutCells& cuts) {
  cuts_ = &cuts;
  cols_ = lattice.cols();
  rows_ = lattice.rows();
  tile_ = lattice.tile();
  errors_.resize(lattice.size());
  for (int step = 1; step < tile_; step *= 2) {
    if (step == 1) {
      measureFinest(lattice.heights());
      markCuts();
    } else {
      measureSides(lattice.heights(), step);
    }
    measureMiddles(lattice.heights(), step);
  }
}

// The smallest triangles have their right angle at vertices with odd i + j: if both of a cell's are used, so are both
// halves of the cell.
void TriangleNetwork::markCuts() {
  const auto width = static_cast<std::uint32_t>(cols_);
  for (const std::uint32_t cell : cuts_->cells()) {
    const bool odd = ((cell / width + cell % width) & 1U) != 0;
    errors_[odd ? cell : cell + 1] = std::numeric_limits<float>::infinity();
    errors_[odd ? cell + width + 1 : cell + width] = std::numeric_limits<float>::infinity();
  }
}

// Removing a vertex and its dependents shifts the surface by at most the sum of their errors, which is therefore a
// bound. First the midpoints of hypotenuses two cells long, along a row or a column; values written for other vertices
// are overwritten by the coarser passes.
void TriangleNetwork::measureFinest(const float* z) {
  const auto width = static_cast<std::size_t>(cols_);
  for (std::size_t j = 0; j < static_cast<std::size_t>(rows_); ++j) {
    const float* line = z + j * width;
    float* error = errors_.data() + j * width;
    if (j % 2 == 0) {
      for (std::size_t i = 1; i + 1 < width; ++i) error[i] = std::abs(line[i] - 0.5F * (line[i - 1] + line[i + 1]));
    } else {
      const float *above = line - width, *below = line + width;
      for (std::size_t i = 0; i < width; ++i) error[i] = std::abs(line[i] - 0.5F * (above[i] + below[i]));
    }
  }
}

// Midpoints of hypotenuses of length 2 step along an axis; four midpoints beside each depend on it.
void TriangleNetwork::measureSides(const float* z, int step) {
  const auto width = static_cast<std::ptrdiff_t>(cols_);
  const std::ptrdiff_t half = step / 2, half_down = half * width;
  for (int j = 0; j < rows_; j += step) {
    const bool odd_row = ((j / step) & 1) != 0;
    const std::ptrdiff_t way = odd_row ? step * width : step;
    const bool above = j > 0, under = j + 1 < rows_;
    for (int i = odd_row ? 0 : step; i < cols_; i += 2 * step) {
      const std::ptrdiff_t at = j * width + i;
      const bool left = i > 0, right = i + 1 < cols_;
      const float* error = errors_.data() + at;
      float below = 0;
      if (above && left) below = std::max(below, error[-half_down - half]);
      if (above && right) below = std::max(below, error[-half_down + half]);
      if (under && left) below = std::max(below, error[half_down - half]);
      if (under && right) below = std::max(below, error[half_down + half]);
      errors_[static_cast<std::size_t>(at)] = std::abs(z[at] - 0.5F * (z[at - way] + z[at + way])) + below;
    }
  }
}

// Midpoints of hypotenuses that span 2 step along both axes, falling and rising alternately; the four beside, above and
// below each depend on it.
void TriangleNetwork::measureMiddles(const float* z, int step) {
  const std::ptrdiff_t width = cols_, down = step * width;
  for (int j = step; j < rows_; j += 2 * step) {
    const bool falling = ((j / step / 2) & 1) == 0;  // whether the first one falls; then alternating
    std::ptrdiff_t way = falling ? down + step : down - step;
    for (int i = step; i < cols_; i += 2 * step, way = 2 * down - way) {
      const std::ptrdiff_t at = j * width + i;
      const float* error = errors_.data() + at;
      const float below = std::max(std::max(error[-step], error[step]), std::max(error[-down], error[down]));
      errors_[static_cast<std::size_t>(at)] = std::abs(z[at] - 0.5F * (z[at - way] + z[at + way])) + below;
    }
  }
}

inline TriangleNetwork::Corner TriangleNetwork::use(std::uint32_t vertex) {
  std::uint32_t& slot = slots_[vertex];
  if (slot == 0) {
    *next_vertex_++ = vertex;
    slot = ++used_;
  }
  return {vertex, slot - 1};
}

// Levels above the finest triangles, which are half cells.
template <int kDepth>
void TriangleNetwork::split(Corner a, Corner b, Corner apex) {
  if constexpr (kDepth == 0) {
    // Half a cell: a and b are its top left and bottom right corners, or its top right and bottom left ones.
    const std::uint32_t upper = std::min(a.vertex, b.vertex), apart = std::max(a.vertex, b.vertex) - upper;
    if (cuts_->contains(apart < static_cast<std::uint32_t>(cols_) ? upper - 1 : upper)) return;
  } else {
    const std::uint32_t middle = (a.vertex + b.vertex) / 2;
    if (errors_[middle] > error_mm_) {
      const Corner between = use(middle);
      split<kDepth - 1>(apex, a, between);
      split<kDepth - 1>(b, apex, between);
      return;
    }
  }
  *next_triangle_++ = {a.place, b.place, apex.place};
}

template <int kDepth>
void TriangleNetwork::splitTile(int i, int j) {
  const auto vertex = [&](int across, int down) {
    return use(static_cast<std::uint32_t>((j + down) * cols_ + i + across));
  };
  const Corner top_left = vertex(0, 0), top_right = vertex(tile_, 0);
  const Corner low_left = vertex(0, tile_), low_right = vertex(tile_, tile_);
  if (((i + j) / tile_ & 1) == 0) {
    split<kDepth>(top_left, low_right, top_right);
    split<kDepth>(low_right, top_left, low_left);
  } else {
    split<kDepth>(low_left, top_right, top_left);
    split<kDepth>(top_right, low_left, low_right);
  }
}

void TriangleNetwork::triangulate(float error_mm) {
  error_mm_ = error_mm;
  if (slots_.size() == errors_.size()) {
    for (const std::uint32_t vertex : vertices_) slots_[vertex] = 0;
  } else {
    slots_.assign(errors_.size(), 0);
  }
  vertices_.clear();
  triangles_.clear();
  next_vertex_ = vertices_.room(errors_.size());
  next_triangle_ = triangles_.room(2 * errors_.size());
  used_ = 0;
  constexpr std::array kSplitTile{&TriangleNetwork::splitTile<0>, &TriangleNetwork::splitTile<2>,
                                  &TriangleNetwork::splitTile<4>, &TriangleNetwork::splitTile<6>,
                                  &TriangleNetwork::splitTile<8>, &TriangleNetwork::splitTile<10>};
  static_assert(HeightLattice::kLargestTile >> kSplitTile.size() == 0);
  const auto split_tile = kSplitTile[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(tile_)))];
  for (int j = 0; j + 1 < rows_; j += tile_) {
    for (int i = 0; i + 1 < cols_; i += tile_) (this->*split_tile)(i, j);
  }
  vertices_.endAt(next_vertex_);
  triangles_.endAt(next_triangle_);
}

}  // namespace relievo
