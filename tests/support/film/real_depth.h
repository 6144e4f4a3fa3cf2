// SPDX-License-Identifier: Apache-2.0
// The real depth video beside the project, where it is at hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/media/frame.h"

namespace relievo::test {

// What the makers of the still life "cones" measured: disparity in pixels between the left eye and the right one, 0
// where it is unknown.
struct Disparity {
  static constexpr int kCols = 450, kRows = 375;
  static constexpr float kMost = 55;  // more than the largest
  std::vector<float> pixels;          // row by row

  [[nodiscard]] float at(int col, int row) const { return pixels[static_cast<std::size_t>(row) * kCols + col]; }
};

// Nothing where the file is not.
[[nodiscard]] std::optional<Disparity> readCones(const std::string& data_folder);

// As a depth picture of 16 bits: linear in disparity from 0 to kMost, code 0 where nothing is known.
[[nodiscard]] Frame depthOf(const Disparity& disparity);

}  // namespace relievo::test
