// SPDX-License-Identifier: Apache-2.0
// The video codecs for writing films, and the bit depths that they support.
#pragma once

#include <cstdint>

namespace relievo {

enum class VideoCodec : std::uint8_t { H264, Hevc, Ffv1 };
[[nodiscard]] const char* name(VideoCodec codec) noexcept;  // "H.264"
// H.264: 8 and 10 bits; HEVC: 8, 10 and 12; FFV1: 8, 10, 12 and 16.
[[nodiscard]] bool codes(VideoCodec codec, int bits) noexcept;

}  // namespace relievo
