// SPDX-License-Identifier: Apache-2.0
// Distances as a renderer writes them, in the whole millimetres of a depth picture.
#pragma once

#include <cmath>
#include <cstdint>

namespace relievo {

// Of metres along the camera's axis, rounded. 0 for what is none: not a number, not in front of the camera, or beyond
// 65.535 m. The stream that it is in says so by DEPTH_UNIT=1 and DEPTH_INVALID=0.
[[nodiscard]] inline std::uint16_t millimetres(float metres) noexcept {
  constexpr float kMmPerMetre = 1000, kBeyond = 65535.5F;
  const float mm = kMmPerMetre * metres;
  return mm > 0 && mm < kBeyond ? static_cast<std::uint16_t>(std::lround(mm)) : std::uint16_t{0};
}

}  // namespace relievo
