// SPDX-License-Identifier: Apache-2.0
// Encodes words as nibbles and decodes them.
#include "drivers/falcon/packet.h"

#include <algorithm>

namespace relievo::falcon {
namespace {

constexpr std::uint8_t kBegin = '<', kEnd = '>', kZero = 'A';
constexpr std::size_t kFlagsAt = 13, kFixedAt = 14;

using Bytes = std::span<const std::uint8_t, kPacketBytes>;

Packet wrap(const std::array<std::int16_t, 3>& words, std::uint8_t flags) RELIEVO_RT {
  Packet packet{};
  packet.front() = kBegin;
  std::size_t at = 1;
  for (const std::int16_t word : words) {
    const auto bits = static_cast<std::uint16_t>(word);
    for (unsigned shift = 0; shift < 16; shift += 4) {
      packet[at++] = static_cast<std::uint8_t>(kZero + ((static_cast<unsigned>(bits) >> shift) & 0xFU));
    }
  }
  packet[kFlagsAt] = static_cast<std::uint8_t>(kZero + flags);
  packet[kFixedAt] = kZero;
  packet.back() = kEnd;
  return packet;
}

bool isPacket(Bytes bytes) RELIEVO_RT {
  if (bytes.front() != kBegin || bytes.back() != kEnd || bytes[kFixedAt] != kZero || bytes[kFlagsAt] < kZero) {
    return false;
  }
  const auto words = bytes.subspan<1, 12>();
  return std::ranges::all_of(words, [](std::uint8_t b) noexcept { return b >= kZero && b < kZero + 16; });
}

std::array<std::int16_t, 3> wordsOf(Bytes bytes) RELIEVO_RT {
  std::array<std::int16_t, 3> words{};
  for (std::size_t i = 0; i < words.size(); ++i) {
    unsigned bits = 0;
    for (std::size_t nibble = 0; nibble < 4; ++nibble) {
      bits |= static_cast<unsigned>(bytes[1 + 4 * i + nibble] - kZero) << (4 * nibble);
    }
    words[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
  }
  return words;
}

}  // namespace

Packet encode(const Command& command) RELIEVO_RT {
  const unsigned flags =
      (command.homing ? 1U : 0U) | (command.green ? 2U : 0U) | (command.blue ? 4U : 0U) | (command.red ? 8U : 0U);
  return wrap(command.motors, static_cast<std::uint8_t>(flags));
}

Packet encode(const Reply& reply) RELIEVO_RT {
  const unsigned flags = (reply.buttons & 0xFU) | ((reply.homed & 7U) << 4U);
  return wrap(reply.encoders, static_cast<std::uint8_t>(flags));
}

std::optional<Reply> decodeReply(Bytes bytes) RELIEVO_RT {
  if (!isPacket(bytes)) return std::nullopt;
  const auto flags = static_cast<unsigned>(bytes[kFlagsAt] - kZero);
  if (flags > 0x7FU) return std::nullopt;
  return Reply{.encoders = wordsOf(bytes),
               .buttons = static_cast<std::uint8_t>(flags & 0xFU),
               .homed = static_cast<std::uint8_t>(flags >> 4U)};
}

std::optional<Command> decodeCommand(Bytes bytes) RELIEVO_RT {
  if (!isPacket(bytes)) return std::nullopt;
  const auto flags = static_cast<unsigned>(bytes[kFlagsAt] - kZero);
  if (flags > 0xFU) return std::nullopt;
  return Command{.motors = wordsOf(bytes),
                 .homing = (flags & 1U) != 0,
                 .green = (flags & 2U) != 0,
                 .blue = (flags & 4U) != 0,
                 .red = (flags & 8U) != 0};
}

void PacketStream::drop(std::size_t count) RELIEVO_RT {
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(count), bytes_.begin() + static_cast<std::ptrdiff_t>(size_),
            bytes_.begin());
  size_ -= count;
}

void PacketStream::add(std::span<const std::uint8_t> bytes) RELIEVO_RT {
  bytes = bytes.last(std::min(bytes.size(), bytes_.size()));
  if (const std::size_t wanted = size_ + bytes.size(); wanted > bytes_.size()) drop(wanted - bytes_.size());
  std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += bytes.size();
}

std::optional<Packet> PacketStream::next() RELIEVO_RT {
  std::size_t from = 0;
  std::optional<Packet> found;
  for (; from < size_; ++from) {
    if (bytes_[from] != kBegin) continue;
    if (size_ - from < kPacketBytes) break;
    Packet candidate{};
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(from), kPacketBytes, candidate.begin());
    if (!isPacket(candidate)) continue;
    found = candidate;
    break;
  }
  drop(from + (found ? kPacketBytes : 0));
  return found;
}

}  // namespace relievo::falcon
