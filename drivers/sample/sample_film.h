// SPDX-License-Identifier: Apache-2.0
// The container that the sample's source reads, and its packets, which the decoders read.
#pragma once

#include <array>
#include <cstdint>

namespace relievo {

// A file is one SampleHeader and then packets, each a SamplePacketHeader and its bytes, to the end; all little endian.
// Stream 0 is gray pictures of 8 bits, row by row. Stream 1 is sound: the count of its frames (uint32), then samples
// of 16 bits, interleaved.
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
