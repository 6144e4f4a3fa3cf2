// SPDX-License-Identifier: Apache-2.0
// The frames of a WebSocket (RFC 6455) as a client reads and writes them, in memory of fixed size.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "platform/realtime.h"

namespace relievo::inverse3 {

enum class Opcode : std::uint8_t { Continuation = 0, Text = 1, Binary = 2, Close = 8, Ping = 9, Pong = 10 };

// A whole message, or a control frame.
struct Message {
  Opcode kind = Opcode::Text;  // never Continuation
  std::string_view payload;
};

// Finds the messages in a stream of bytes that arrive in pieces of any size.
class FrameReader {
 public:
  static constexpr std::size_t kMostMessage = 32 * 1024;

  void clear() RELIEVO_RT;
  // The memory for the next bytes; empty until `next` has taken messages that have arrived whole. What `next` returned
  // becomes invalid.
  [[nodiscard]] std::span<char> room() RELIEVO_RT;
  void received(std::size_t bytes) RELIEVO_RT { end_ += bytes; }
  // The next message, valid until the next call of `room` or `next`; empty until it has arrived whole.
  [[nodiscard]] std::optional<Message> next() RELIEVO_RT;
  // The stream breaks the protocol, or a message is too long: nothing more can be read from it until `clear`.
  [[nodiscard]] bool broken() const RELIEVO_RT { return broken_; }

 private:
  struct Header {
    Opcode kind = Opcode::Continuation;
    bool final = false;
    std::size_t bytes = 0, payload = 0;
  };
  [[nodiscard]] std::optional<Header> header() RELIEVO_RT;
  [[nodiscard]] std::optional<Message> add(const Header& header, std::string_view payload) RELIEVO_RT;
  std::nullopt_t breach() RELIEVO_RT;

  std::array<char, 2 * kMostMessage> bytes_{};
  std::size_t begin_ = 0, end_ = 0;  // of what has arrived and was not returned
  std::array<char, kMostMessage> pieces_{};
  std::size_t pieced_ = 0;
  std::optional<Opcode> piecing_;  // kind of the fragmented message that is arriving
  bool broken_ = false;
};

// Writes one masked frame with a payload of less than 64 KiB; returns its length, 0 if `out` is too small.
[[nodiscard]] std::size_t writeFrame(Opcode kind, std::string_view payload, std::uint32_t mask,
                                     std::span<char> out) RELIEVO_RT;

}  // namespace relievo::inverse3
