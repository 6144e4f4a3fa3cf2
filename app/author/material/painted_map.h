// SPDX-License-Identifier: Apache-2.0
// A picture painted by a person: red is stiffness, green friction, blue texture; gray is stiffness alone.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hal/media/frame.h"

namespace relievo {

// Shares of the full codes, 0 to 255, row by row. Where the picture is transparent, nothing is painted.
struct PaintedMap {
  using Codes = std::array<std::uint8_t, 3>;  // stiffness, friction, texture
  int cols = 0, rows = 0;
  std::vector<Codes> codes;
  std::vector<bool> painted;

  [[nodiscard]] std::size_t index(int c, int r) const noexcept {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c);
  }
};

// The picture in this size, each sample as the middle of its part.
[[nodiscard]] PaintedMap readMap(const Frame& picture, int cols, int rows);

}  // namespace relievo
