// SPDX-License-Identifier: Apache-2.0
// The 16-byte packets that host and Falcon exchange while its firmware runs, and a parser that finds them in a stream.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/falcon/kinematics.h"
#include "platform/realtime.h"

namespace relievo::falcon {

// '<', three words of four nibbles (least significant first, each + 'A'), a byte of flags + 'A', 'A', '>'. The device
// sends exactly one reply for each command. (After libnifalcon, BSD licence.)
inline constexpr std::size_t kPacketBytes = 16;
using Packet = std::array<std::uint8_t, kPacketBytes>;

// Motor words range from -kMostWord to kMostWord, as in the nine published packets of the maker's driver.
inline constexpr int kMostWord = 4095;
using Words = std::array<std::int16_t, 3>;

struct Command {
  Words motors{};
  bool homing = false;
  bool green = false, blue = false, red = false;  // the light ring
};

struct Reply {
  Counts encoders{};
  std::uint8_t buttons = 0;  // 1 right, 2 front, 4 centre, 8 left
  std::uint8_t homed = 0;    // bit i: leg i has found its index
  [[nodiscard]] bool allHomed() const RELIEVO_RT { return homed == 7; }
};

[[nodiscard]] Packet encode(const Command& command) RELIEVO_RT;
[[nodiscard]] Packet encode(const Reply& reply) RELIEVO_RT;  // the device's side
// nullopt unless the marks, the nibbles and the fixed byte are all valid.
[[nodiscard]] std::optional<Reply> decodeReply(std::span<const std::uint8_t, kPacketBytes> bytes) RELIEVO_RT;
[[nodiscard]] std::optional<Command> decodeCommand(std::span<const std::uint8_t, kPacketBytes> bytes) RELIEVO_RT;

// Finds packets in a stream that may begin, be split or be corrupted anywhere. It skips invalid data byte by byte, so
// it finds the first whole packet after any fault.
class PacketStream {
 public:
  // Appends bytes; drops the oldest beyond its capacity of eight packets.
  void add(std::span<const std::uint8_t> bytes) RELIEVO_RT;
  // The next whole packet that is a valid reply; nullopt if more bytes are needed.
  [[nodiscard]] std::optional<Packet> next() RELIEVO_RT;
  void clear() RELIEVO_RT { size_ = 0; }

 private:
  void drop(std::size_t count) RELIEVO_RT;
  std::array<std::uint8_t, 8 * kPacketBytes> bytes_{};
  std::size_t size_ = 0;
};

}  // namespace relievo::falcon
