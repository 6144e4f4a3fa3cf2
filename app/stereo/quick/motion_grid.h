// SPDX-License-Identifier: Apache-2.0
// Changes of disparity from picture to picture, by place and by surface.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "app/stereo/disparity_map.h"

namespace relievo {

// Means over cells of the picture and of disparity (a bilateral grid; Chen, Paris and Durand 2007), so that what moves
// in front of a still wall leaves the wall still.
class MotionGrid {
 public:
  // Empty, for a picture of this size and disparities from `lowest` to `highest`.
  void begin(int cols, int rows, float lowest, float highest);
  void add(int c, int r, float disparity, float change) noexcept {
    Cell& cell = cells_[place((c + kCell / 2) / kCell, (r + kCell / 2) / kCell, layerOf(disparity))];
    cell.count += 1;
    cell.sum += change;
  }
  // Call after all changes were added.
  void smooth();
  struct Change {
    float pixels = 0;     // the surrounding mean, interpolated between cells; a mean near the noise counts little
    float stillness = 1;  // near 1 if it is no more than noise, near 0 if it is much more
  };
  [[nodiscard]] Change at(int c, int r, float disparity) const noexcept {
    const float u = static_cast<float>(c % kCell) / kCell, v = static_cast<float>(r % kCell) / kCell;
    const float* const above = &means_[place(c / kCell, r / kCell, layerOf(disparity))];
    const float* const below = above + cols_;
    const float change = (1 - v) * ((1 - u) * above[0] + u * above[1]) + v * ((1 - u) * below[0] + u * below[1]);
    const float stillness = kNoise * kNoise / (change * change + kNoise * kNoise);
    return {change * (1 - stillness), stillness};
  }

 private:
  static constexpr int kCell = 16;        // pixels
  static constexpr float kLayer = 1.5F;   // pixels of disparity
  static constexpr float kNoise = 0.03F;  // pixels: error of a cell's mean where nothing moves

  struct Cell {
    float count = 0, sum = 0;
  };
  [[nodiscard]] std::size_t place(int x, int y, int layer) const noexcept {
    return (static_cast<std::size_t>(layer) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(cols_) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] int layerOf(float disparity) const noexcept {
    return std::clamp(nearest((disparity - lowest_) * (1 / kLayer)), 0, layers_ - 1);
  }
  void smoothAlong(std::size_t stride, int length);
  void takeMeans();

  int cols_ = 0, rows_ = 0, layers_ = 0;
  float lowest_ = 0;
  std::vector<Cell> cells_, smoothed_;
  std::vector<float> means_;  // of the cells' changes
};

}  // namespace relievo
