// SPDX-License-Identifier: Apache-2.0
// One eye's picture as the matcher takes it: brightness and colour of 8 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/media/frame.h"

namespace relievo {

// Row by row without gaps; three bytes a pixel: luma of full range, blue and red difference around 128.
struct ViewPicture {
  int cols = 0, rows = 0;
  std::vector<std::uint8_t> yuv;

  ViewPicture() = default;
  ViewPicture(int width, int height) : cols(width), rows(height), yuv(3 * size()) {}
  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(cols) * rows; }
};

// Any colour picture: YUV as it is but for its range and bits, RGB by the weights of BT.601, gray without colour.
[[nodiscard]] ViewPicture readView(const Frame& frame);

}  // namespace relievo
