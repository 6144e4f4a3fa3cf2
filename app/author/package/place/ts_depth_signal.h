// SPDX-License-Identifier: Apache-2.0
// Marks a stream as depth in a transport stream's programme map, which FFmpeg's muxer cannot do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "app/coding/video_codec.h"

namespace relievo {

// In each map the stream with this PID gets the type 0x1E, auxiliary video (ISO/IEC 13818-1, table 2-34), and the
// matching descriptor with its coding; the checksum is recomputed. A map must fit in one packet, as it does with a few
// streams.
class TsDepthSignal {
 public:
  static constexpr std::size_t kPacket = 188;
  static constexpr std::uint16_t kMapPid = 0x1000, kDepthPid = 0x101;  // as set in the muxer

  explicit TsDepthSignal(VideoCodec codec) noexcept : coding_(codec == VideoCodec::Hevc ? 0x24 : 0x1b) {}
  // Takes whole packets; changes only maps.
  void rewrite(std::span<std::uint8_t> packets) const noexcept;

 private:
  void rewriteMap(std::span<std::uint8_t> section) const noexcept;

  std::uint8_t coding_;
};

// ISO/IEC 13818-1, annex A.
[[nodiscard]] std::uint32_t mpegChecksum(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace relievo
