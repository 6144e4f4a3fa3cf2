// SPDX-License-Identifier: Apache-2.0
// The disparity of each point of the left view in the right one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace relievo {

// The disparities of a scene's points, in pixels of a view: x in the left view minus x in the right one. Near is high;
// 0 lies in the screen, negative behind it.
struct DisparityRange {
  int lowest = 0, highest = 0;
};

// The nearest whole number, halves away from 0: std::lround without its call.
[[nodiscard]] inline int nearest(float x) noexcept {
  return static_cast<int>(x + (x < 0 ? -0.5F : 0.5F));
}

struct DisparityMap {
  int cols = 0, rows = 0;
  std::vector<float> pixels;       // row by row
  std::vector<float> from_right;   // likewise, of the right view's pixels
  std::vector<std::uint8_t> seen;  // 1: the point was found in both views; else its disparity is inferred

  DisparityMap() = default;
  DisparityMap(int width, int height) : cols(width), rows(height), pixels(size()), from_right(size()), seen(size()) {}
  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(cols) * rows; }
  [[nodiscard]] std::size_t at(int c, int r) const noexcept { return static_cast<std::size_t>(r) * cols + c; }
};

}  // namespace relievo
