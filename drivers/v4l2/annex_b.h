// SPDX-License-Identifier: Apache-2.0
// Coded packets as hardware takes them: with start codes, and with parameter sets where decoding begins.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/media_source.h"
#include "platform/error.h"

namespace relievo::v4l2 {

// What a stream's parameter sets say of it (profile_idc of ISO/IEC 14496-10 and 23008-2).
struct CodingProfile {
  int profile = 0;
  bool plain = false;  // 8 bits, 4:2:0
};

// H.264 and HEVC (ISO/IEC 14496-10 and 23008-2, annexes B). MP4 and Matroska put a length before each unit and keep the
// parameter sets apart (ISO/IEC 14496-15); transport streams are as they should be already, and so is any other codec.
class AnnexB {
 public:
  // Corrupt where the container's description makes no sense.
  [[nodiscard]] static Result<AnnexB> make(const StreamInfo& stream);

  // Nothing where the stream does not tell, or another codec has none.
  [[nodiscard]] std::optional<CodingProfile> profile() const noexcept;
  // Writes a packet, with the parameter sets that the container keeps apart where it is a key frame or
  // `with_parameters`, unless it has some of its own. The bytes written; nothing for a damaged packet, or one too large
  // for the room.
  [[nodiscard]] std::optional<std::size_t> write(const Packet& packet, bool with_parameters,
                                                 std::span<std::uint8_t> room) const noexcept;

 private:
  [[nodiscard]] bool readAvcDescription(std::span<const std::uint8_t> extradata);
  [[nodiscard]] bool readHevcDescription(std::span<const std::uint8_t> extradata);
  void addUnit(std::span<const std::uint8_t> unit);
  [[nodiscard]] std::span<const std::uint8_t> sequenceSetIn(std::span<const std::uint8_t> units) const noexcept;

  enum class Codec : std::uint8_t { Other, H264, Hevc } codec_ = Codec::Other;
  std::size_t length_bytes_ = 0;  // before each unit; 0: there are start codes
  std::vector<std::uint8_t> parameters_;
};

}  // namespace relievo::v4l2
