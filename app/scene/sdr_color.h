// SPDX-License-Identifier: Apache-2.0
// Tone-maps the colours of HDR pictures for an SDR screen.
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace relievo {

// The SDR rendering of HDR: white is HDR's reference white, the peak is that of most masters.
inline constexpr double kSdrWhiteCdM2 = 203;  // ITU-R BT.2408, table 1
inline constexpr double kHdrPeakCdM2 = 1000;  // likewise
inline constexpr double kSdrGamma = 2.4;      // ITU-R BT.1886
inline constexpr double kHlgGamma = 1.2;      // of the system, for a screen of that peak: ITU-R BT.2100-2, table 5
inline constexpr glm::dvec3 kBt2020Luminance{0.2627, 0.6780, 0.0593};

// "PQ" or "HLG"; nullptr for another transfer. `transfer` as in a Frame.
[[nodiscard]] const char* hdrName(std::uint8_t transfer) noexcept;
[[nodiscard]] bool isHlg(std::uint8_t transfer) noexcept;
// True for BT.2020's primaries; HDR that does not state its primaries counts as BT.2020.
[[nodiscard]] bool isBt2020(std::uint8_t primaries) noexcept;

// ITU-R BT.2087-0, annex 1; for linear light, by columns.
inline constexpr glm::dmat3 kBt709FromBt2020{1.6605,  -0.1246, -0.0182,  // of red,
                                             -0.5876, 1.1329,  -0.1006,  // green,
                                             -0.0728, -0.0083, 1.1187};  // blue

// The first step of asSdr, for one component's code, 0 to 1: returns cd/m2 for PQ, a share of the scene's light for
// HLG.
[[nodiscard]] double hdrLight(double code, std::uint8_t transfer) noexcept;
// The second step: the light in cd/m2 that the screen shows for the brightest component; at most kSdrWhiteCdM2.
[[nodiscard]] double compressedLight(double light) noexcept;

// `transfer` and `primaries` as in a Frame. PQ and HLG become gamma 2.4, BT.2020 becomes BT.709. HDR's reference white,
// 203 cd/m2, is a little below white, and what is brighter, up to 1000 cd/m2, is compressed into the rest. Colours with
// another transfer are returned as they are. Pure.
[[nodiscard]] glm::dvec3 asSdr(const glm::dvec3& color, std::uint8_t transfer, std::uint8_t primaries) noexcept;

}  // namespace relievo
