// SPDX-License-Identifier: Apache-2.0
// An RGB picture to draw into, and its PNG encoding.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/error.h"

namespace relievo {

using RgbPixel = std::array<std::uint8_t, 3>;

struct RgbPicture {
  int width = 0, height = 0;
  std::vector<RgbPixel> pixels;  // row by row

  RgbPicture(int cols, int rows, const RgbPixel& color)
      : width(cols), height(rows), pixels(static_cast<std::size_t>(cols) * rows, color) {}
  [[nodiscard]] RgbPixel& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

// The bytes of a PNG file.
[[nodiscard]] Result<std::string> encodePng(const RgbPicture& picture);

}  // namespace relievo
