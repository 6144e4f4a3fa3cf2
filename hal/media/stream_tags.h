// SPDX-License-Identifier: Apache-2.0
// Tags inside a video stream, for containers that cannot store any: transport streams, HLS.
#pragma once

#include <array>
#include <cstdint>

namespace relievo {

// With key frames of H.264 and HEVC, as "user data unregistered" (supplemental enhancement information, payload type
// 5): this UUID, then lines KEY=VALUE (DEPTH_LAW=inverse, ..). The container's tags override them.
inline constexpr std::array<std::uint8_t, 16> kStreamTagsUuid{0x6e, 0x1f, 0x43, 0xb7, 0x0d, 0x52, 0x4c, 0x9e,
                                                              0xa7, 0x35, 0x72, 0x65, 0x6c, 0x69, 0x65, 0x76};

}  // namespace relievo
