// SPDX-License-Identifier: Apache-2.0
// In which part of a sample its depth is written.
#pragma once

#include <array>
#include <cstdint>

namespace relievo {

// What a sample's code is: its brightness, its hue, or its place in a colour map.
enum class DepthCode : std::uint8_t {
  Luma,
  Hue,
  Turbo,
  Jet,
  Inferno,
  Magma,
  Viridis,
  Plasma,
  Rainbow,
  Spectral,  // from blue to red
  Kinect,    // black (no depth), blue, cyan, white
  YlGnBu     // from yellow to blue
};
inline constexpr std::array kDepthCodes{DepthCode::Luma,    DepthCode::Hue,      DepthCode::Turbo,   DepthCode::Jet,
                                        DepthCode::Inferno, DepthCode::Magma,    DepthCode::Viridis, DepthCode::Plasma,
                                        DepthCode::Rainbow, DepthCode::Spectral, DepthCode::Kinect,  DepthCode::YlGnBu};
// The word on the command line.
[[nodiscard]] const char* name(DepthCode code) noexcept;

}  // namespace relievo
