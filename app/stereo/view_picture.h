// SPDX-License-Identifier: Apache-2.0
// One eye's picture as the matcher takes it: 8-bit brightness and colour.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "app/scene/byte_picture.h"
#include "hal/media/frame.h"

namespace relievo {

// Luma of full range, blue and red difference around 128.
struct LumaAndColor {
  static constexpr std::size_t kCount = 3;
};
using ViewPicture = BytePicture<LumaAndColor>;

// The luma alone, pixel by pixel.
void lumaOf(const ViewPicture& view, std::vector<std::uint8_t>& luma);

// The sum of the differences of two pixels' parts, in levels.
[[nodiscard]] inline int unlikeness(const std::uint8_t* p, const std::uint8_t* q) noexcept {
  return std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]);
}

// Converts any colour picture: YUV adjusted only in range and bits, RGB by the weights of BT.601, gray without colour.
[[nodiscard]] ViewPicture readView(const Frame& frame);

}  // namespace relievo
