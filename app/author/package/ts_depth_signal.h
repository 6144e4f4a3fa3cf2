// SPDX-License-Identifier: Apache-2.0
// Says in a transport stream's programme map that a stream is depth, which FFmpeg's muxer has no word for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "app/coding/video_codec.h"

namespace relievo {

// Each map gives the stream of that PID the type 0x1E, auxiliary video (ISO/IEC 13818-1, table 2-34), and the
// descriptor that goes with it and names the coding; its checksum is made anew. A map lies in one packet, as it does
// for a few streams.
class TsDepthSignal {
 public:
  static constexpr std::size_t kPacket = 188;
  static constexpr std::uint16_t kMapPid = 0x1000, kDepthPid = 0x101;  // as the muxer is told

  explicit TsDepthSignal(VideoCodec codec) noexcept : coding_(codec == VideoCodec::Hevc ? 0x24 : 0x1b) {}
  // Whole packets; others than maps stay as they are.
  void rewrite(std::span<std::uint8_t> packets) const noexcept;

 private:
  void rewriteMap(std::span<std::uint8_t> section) const noexcept;

  std::uint8_t coding_;
};

// ISO/IEC 13818-1, annex A.
[[nodiscard]] std::uint32_t mpegChecksum(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace relievo
