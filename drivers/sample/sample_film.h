// SPDX-License-Identifier: Apache-2.0
// The container format of sample films, and their packets.
#pragma once

#include <array>
#include <cstdint>

namespace relievo {

// A file is one SampleHeader, then packets, each a SamplePacketHeader and its bytes; all little endian.
// Stream 0 has 8-bit gray pictures, row by row. Stream 1 has sound: the number of frames (uint32), then 16-bit samples,
// interleaved.
inline constexpr std::array<char, 8> kSampleMagic{'r', 'e', 'l', 's', 'a', 'm', 'p', '1'};
inline constexpr const char* kSamplePictures = "sample-pictures";  // the codecs
inline constexpr const char* kSampleSound = "sample-sound";

struct SampleHeader {
  std::array<char, 8> magic = kSampleMagic;
  std::uint32_t width = 0, height = 0;
  std::int64_t frame_period_ns = 0;
  std::uint32_t sample_rate_hz = 0;  // 0: there is no sound
  std::uint32_t channels = 0;
  std::array<char, 32> title{};
};

struct SamplePacketHeader {
  std::int64_t pts_ns = 0;
  std::uint32_t bytes = 0;
  std::uint16_t stream = 0;
  std::uint16_t keyframe = 0;
};

}  // namespace relievo
