// SPDX-License-Identifier: Apache-2.0
// The errors of the vertices from the fine to the coarse, and the triangles from the coarse to the fine.
#include "app/render/triangle_network.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace relievo {

void TriangleNetwork::measure(const HeightLattice& lattice, float jump_mm) {
  cols_ = lattice.cols();
  rows_ = lattice.rows();
  tile_ = lattice.tile();
  errors_.assign(lattice.size(), 0.0F);
  findCuts(lattice, jump_mm);
  for (int step = 1; step < tile_; step *= 2) measureLevel(lattice.heights(), step);
}

// The smallest triangles have their right angles at the vertices with i + j odd: where those two of a cell are there,
// so are the two halves of the cell.
void TriangleNetwork::findCuts(const HeightLattice& lattice, float jump_mm) {
  const float* z = lattice.heights();
  const auto width = static_cast<std::size_t>(cols_);
  cut_.resize(lattice.size() + sizeof(std::uint64_t));
  cut_cells_.clear();
  for (int j = 0; j + 1 < rows_; ++j) {
    const float* top = z + static_cast<std::size_t>(j) * width;
    const float* low = top + width;
    std::uint8_t* cut = cut_.data() + static_cast<std::size_t>(j) * width;
    for (int i = 0; i + 1 < cols_; ++i) {
      const float across = std::max(std::abs(top[i + 1] - top[i]), std::abs(low[i + 1] - low[i]));
      const float down = std::max(std::abs(low[i] - top[i]), std::abs(low[i + 1] - top[i + 1]));
      cut[i] = std::max(across, down) > jump_mm ? 1 : 0;
    }
    cut[cols_ - 1] = 0;
    for (std::size_t i = 0; i < width; i += sizeof(std::uint64_t)) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, cut + i, sizeof eight);
      if (eight == 0) continue;
      for (std::size_t k = i; k < std::min(i + sizeof eight, width); ++k) {
        if (cut[k] == 0) continue;
        const std::size_t corner = static_cast<std::size_t>(j) * width + k;
        cut_cells_.push_back(static_cast<std::uint32_t>(corner));
        const bool odd = ((static_cast<std::size_t>(j) + k) & 1U) != 0;
        errors_[odd ? corner : corner + 1] = std::numeric_limits<float>::infinity();
        errors_[odd ? corner + width + 1 : corner + width] = std::numeric_limits<float>::infinity();
      }
    }
  }
}

// Of the triangles with a hypotenuse of 2 step along an axis, then of those with one of 2 step along both. Leaving a
// vertex out moves the surface at most by what it moves there, and so do those that depend on it: the sum is a bound.
void TriangleNetwork::measureLevel(const float* z, int step) {
  const auto width = static_cast<std::ptrdiff_t>(cols_);
  const std::ptrdiff_t down = step * width;
  const int half = step / 2;
  const std::ptrdiff_t near_down = half * width;
  float* error = errors_.data();
  const auto own = [z](std::ptrdiff_t at, std::ptrdiff_t way) {
    return std::abs(z[at] - 0.5F * (z[at - way] + z[at + way]));
  };
  for (int j = 0; j < rows_; j += step) {
    const bool odd_row = ((j / step) & 1) != 0;
    const std::ptrdiff_t line = j * width;
    const std::ptrdiff_t way = odd_row ? down : step;
    for (int i = odd_row ? 0 : step; i < cols_; i += 2 * step) {
      const std::ptrdiff_t at = line + i;
      float below = 0;
      if (half > 0) {
        if (j > 0 && i > 0) below = std::max(below, error[at - near_down - half]);
        if (j > 0 && i + 1 < cols_) below = std::max(below, error[at - near_down + half]);
        if (j + 1 < rows_ && i > 0) below = std::max(below, error[at + near_down - half]);
        if (j + 1 < rows_ && i + 1 < cols_) below = std::max(below, error[at + near_down + half]);
      } else {
        below = error[at];  // without end, of a cut cell
      }
      error[at] = own(at, way) + below;
    }
  }
  for (int j = step; j < rows_; j += 2 * step) {
    for (int i = step; i < cols_; i += 2 * step) {
      const std::ptrdiff_t at = j * width + i;
      const bool falling = (((i - step) / (2 * step) + (j - step) / (2 * step)) & 1) == 0;
      const float below =
          std::max(std::max(error[at - step], error[at + step]), std::max(error[at - down], error[at + down]));
      error[at] = own(at, falling ? down + step : down - step) + below;
    }
  }
}

void TriangleNetwork::triangulate(float error_mm) {
  error_mm_ = error_mm;
  triangles_.clear();
  const int depth = 2 * std::countr_zero(static_cast<unsigned>(tile_));
  const auto vertex = [this](int i, int j) { return static_cast<std::uint32_t>(j * cols_ + i); };
  for (int j = 0; j + 1 < rows_; j += tile_) {
    for (int i = 0; i + 1 < cols_; i += tile_) {
      const std::uint32_t top_left = vertex(i, j), top_right = vertex(i + tile_, j);
      const std::uint32_t low_left = vertex(i, j + tile_), low_right = vertex(i + tile_, j + tile_);
      if (((i + j) / tile_ & 1) == 0) {
        split(top_left, low_right, top_right, depth);
        split(low_right, top_left, low_left, depth);
      } else {
        split(low_left, top_right, top_left, depth);
        split(top_right, low_left, low_right, depth);
      }
    }
  }
}

void TriangleNetwork::split(std::uint32_t a, std::uint32_t b, std::uint32_t apex, int depth) {
  const std::uint32_t middle = (a + b) / 2;
  if (depth > 0 && errors_[middle] > error_mm_) {
    split(apex, a, middle, depth - 1);
    split(b, apex, middle, depth - 1);
    return;
  }
  if (depth == 0) {
    // Of half a cell the top left corner of the cell is in the row of its upper corners and the column of its left.
    const auto width = static_cast<std::uint32_t>(cols_);
    const std::uint32_t row = std::min({a / width, b / width, apex / width});
    const std::uint32_t col = std::min({a % width, b % width, apex % width});
    if (cut_[row * width + col] != 0) return;
  }
  triangles_.push_back({a, b, apex});
}

}  // namespace relievo
