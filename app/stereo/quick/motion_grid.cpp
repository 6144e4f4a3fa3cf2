// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/motion_grid.h"

#include <algorithm>
#include <cmath>

namespace relievo {
namespace {

constexpr float kNoise = 0.03F;  // pixels: what a mean of cells is off by where nothing moves
constexpr float kFew = 64;       // pixels of a surface that tell half as much as many

}  // namespace

// One cell more on each side is there to look between.
void MotionGrid::begin(int cols, int rows, float lowest, float highest) {
  cols_ = cols / kCell + 2;
  rows_ = rows / kCell + 2;
  layers_ = static_cast<int>(std::max(0.0F, highest - lowest) / kLayer) + 2;
  lowest_ = lowest;
  cells_.assign(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(layers_),
                Cell{});
}

int MotionGrid::layerOf(float disparity) const noexcept {
  return std::clamp(static_cast<int>(std::lround((disparity - lowest_) / kLayer)), 0, layers_ - 1);
}

void MotionGrid::add(int c, int r, float disparity, float change) noexcept {
  Cell& cell = cells_[place((c + kCell / 2) / kCell, (r + kCell / 2) / kCell, layerOf(disparity))];
  cell.count += 1;
  cell.sum += change;
}

void MotionGrid::smooth() {
  const auto row = static_cast<std::size_t>(cols_), layer = row * static_cast<std::size_t>(rows_);
  smoothAlong(1, cols_);
  smoothAlong(row, rows_);
  smoothAlong(layer, layers_);
}

// By 1, 2, 1.
void MotionGrid::smoothAlong(std::size_t stride, int length) {
  smoothed_ = cells_;
  const auto count = static_cast<std::size_t>(length);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::size_t along = i / stride % count;
    Cell sum{2 * cells_[i].count, 2 * cells_[i].sum};
    for (const auto* side :
         {along > 0 ? &cells_[i - stride] : nullptr, along + 1 < count ? &cells_[i + stride] : nullptr}) {
      if (side == nullptr) continue;
      sum.count += side->count;
      sum.sum += side->sum;
    }
    smoothed_[i] = {sum.count / 4, sum.sum / 4};
  }
  cells_.swap(smoothed_);
}

MotionGrid::Change MotionGrid::at(int c, int r, float disparity) const noexcept {
  const float x = static_cast<float>(c) / kCell, y = static_cast<float>(r) / kCell;
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const int k = layerOf(disparity);
  const float u = x - static_cast<float>(i), v = y - static_cast<float>(j);
  const auto mean = [&](int column, int row) {
    const Cell& cell = cells_[place(column, row, k)];
    return cell.sum / (cell.count + kFew);
  };
  const float change =
      (1 - v) * ((1 - u) * mean(i, j) + u * mean(i + 1, j)) + v * ((1 - u) * mean(i, j + 1) + u * mean(i + 1, j + 1));
  const float stillness = kNoise * kNoise / (change * change + kNoise * kNoise);
  return {change * (1 - stillness), stillness};
}

}  // namespace relievo
