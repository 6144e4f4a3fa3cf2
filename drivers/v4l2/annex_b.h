// SPDX-License-Identifier: Apache-2.0
// Converts coded packets to the form that hardware decodes: with start codes, and parameter sets where decoding begins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo::v4l2 {

// From a stream's parameter sets (profile_idc of ISO/IEC 14496-10 and 23008-2).
struct CodingProfile {
  int profile = 0;
  bool plain = false;  // 8 bits, 4:2:0
};

// True if decoding can begin at a packet of H.264 with start codes: it has a sequence set or an IDR picture.
[[nodiscard]] bool isAvcKey(std::span<const std::uint8_t> units) noexcept;

// For H.264 and HEVC (ISO/IEC 14496-10 and 23008-2, annex B of each). MP4 and Matroska put a length before each unit
// and store the parameter sets separately (ISO/IEC 14496-15). Transport streams and other codecs need no conversion.
class AnnexB {
 public:
  // Corrupt if the container's description is invalid.
  [[nodiscard]] static Result<AnnexB> make(const StreamInfo& stream);

  // nullopt if the stream does not state it, or for another codec.
  [[nodiscard]] std::optional<CodingProfile> profile() const noexcept;
  // Writes a packet to `room`. Before a key frame, or if `with_parameters`, writes the container's parameter sets
  // unless the packet has its own. Returns the bytes written; nullopt for a damaged packet, or one too large for
  // `room`.
  [[nodiscard]] std::optional<std::size_t> write(const Packet& packet, bool with_parameters,
                                                 std::span<std::uint8_t> room) const noexcept;

 private:
  [[nodiscard]] bool readAvcDescription(std::span<const std::uint8_t> extradata);
  [[nodiscard]] bool readHevcDescription(std::span<const std::uint8_t> extradata);
  void addUnit(std::span<const std::uint8_t> unit);
  [[nodiscard]] std::span<const std::uint8_t> sequenceSetIn(std::span<const std::uint8_t> units) const noexcept;

  enum class Codec : std::uint8_t { Other, H264, Hevc } codec_ = Codec::Other;
  std::size_t length_bytes_ = 0;  // of the length before each unit; 0: start codes
  std::vector<std::uint8_t> parameters_;
};

}  // namespace relievo::v4l2
