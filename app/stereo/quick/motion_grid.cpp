// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/motion_grid.h"

#include <algorithm>

namespace relievo {
namespace {

constexpr float kFew = 24;  // pixels of a surface: with so few, its mean gets half the weight

}  // namespace

// One extra cell on each side, for interpolation.
void MotionGrid::begin(int cols, int rows, float lowest, float highest) {
  cols_ = cols / kCell + 2;
  rows_ = rows / kCell + 2;
  layers_ = static_cast<int>(std::max(0.0F, highest - lowest) / kLayer) + 2;
  lowest_ = lowest;
  cells_.assign(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(layers_),
                Cell{});
}

void MotionGrid::smooth() {
  const auto row = static_cast<std::size_t>(cols_), layer = row * static_cast<std::size_t>(rows_);
  smoothAlong(1, cols_);
  smoothAlong(row, rows_);
  smoothAlong(layer, layers_);
  takeMeans();
}

// By 1, 2, 1.
void MotionGrid::smoothAlong(std::size_t stride, int length) {
  smoothed_.resize(cells_.size());
  const std::size_t last = stride * static_cast<std::size_t>(length - 1);
  for (std::size_t line = 0; line < cells_.size(); line += last + stride) {
    for (std::size_t along = 0; along <= last; along += stride) {
      const Cell* const here = &cells_[line + along];
      Cell* const out = &smoothed_[line + along];
      const float before = along > 0 ? 0.25F : 0, after = along < last ? 0.25F : 0;
      const Cell* const left = along > 0 ? here - stride : here;
      const Cell* const right = along < last ? here + stride : here;
      for (std::size_t i = 0; i < stride; ++i) {
        out[i] = {0.5F * here[i].count + before * left[i].count + after * right[i].count,
                  0.5F * here[i].sum + before * left[i].sum + after * right[i].sum};
      }
    }
  }
  cells_.swap(smoothed_);
}

void MotionGrid::takeMeans() {
  means_.resize(cells_.size());
  std::ranges::transform(cells_, means_.begin(), [](const Cell& cell) { return cell.sum / (cell.count + kFew); });
}

}  // namespace relievo
