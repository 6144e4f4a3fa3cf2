// SPDX-License-Identifier: Apache-2.0
// Converts distances from a renderer (metres, floating point) to a depth picture's codes (whole millimetres).
#pragma once

#include <cmath>
#include <cstdint>

namespace relievo {

// `metres`: along the camera's axis. The result is rounded; 0 is the invalid code, for what is not a number, not in
// front of the camera, or beyond 65.535 m. The stream's tags for these codes are DEPTH_UNIT=1 and DEPTH_INVALID=0.
[[nodiscard]] inline std::uint16_t millimetres(float metres) noexcept {
  constexpr float kMmPerMetre = 1000, kBeyond = 65535.5F;
  const float mm = kMmPerMetre * metres;
  return mm > 0 && mm < kBeyond ? static_cast<std::uint16_t>(std::lround(mm)) : std::uint16_t{0};
}

}  // namespace relievo
