// SPDX-License-Identifier: Apache-2.0
// The conversation with the Haply Inverse service: text messages over a WebSocket, one answer to each.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/force/force_port.h"
#include "drivers/inverse3/frames.h"
#include "drivers/inverse3/wire.h"
#include "platform/clock.h"

namespace relievo::inverse3 {

// `open`, `close`, `startExchange` and `stopExchange` on the owner's thread; `listen`, `next` and `post` on one thread,
// without waiting or allocating; `quieten` on any thread.
class Channel final : public ForcePort {
 public:
  // At most this many messages wait for an answer. With one, a service slower than the ticks cannot fall behind, and a
  // surplus or missing answer shifts the ages by only one exchange.
  static constexpr std::uint32_t kMostWaiting = 1;

  Channel(std::unique_ptr<Wire> wire, std::string host, Clock& clock)
      : wire_(std::move(wire)), host_(std::move(host)), clock_(clock) {}

  // As Wire::open; Unsupported if what answers is no WebSocket.
  [[nodiscard]] Result<void> open(const std::atomic<bool>& cancelled);
  void close() noexcept;

  // Receives what has arrived. Lost once the connection has ended or breaks the protocol.
  [[nodiscard]] Result<void> listen() RELIEVO_RT;
  struct Answer {
    std::string_view text;
    std::optional<Duration> age;  // since the message that it answers; empty if it answers none
  };
  // The next message received, valid until the next call of `next` or `listen`.
  [[nodiscard]] std::optional<Answer> next() RELIEVO_RT;

  [[nodiscard]] Result<void> startExchange(PortBytes quiet) override;
  // False while a message has no answer, unless this is the first quiet one, and while the system's buffer is full.
  [[nodiscard]] Result<bool> post(PortBytes text) RELIEVO_RT override;
  void stopExchange() noexcept override { exchanging_ = false; }
  // Ends the connection if the message cannot be sent: the service then lets the device go.
  bool quieten() noexcept override;

 private:
  static constexpr std::size_t kTimes = 64;

  [[nodiscard]] Result<void> upgrade(const std::atomic<bool>& cancelled);
  [[nodiscard]] Result<std::string> answerTo(const std::string& request, const std::atomic<bool>& cancelled);
  // Call these three only while holding `turn_`. `put` returns false if an earlier frame is not sent yet.
  [[nodiscard]] Result<bool> put(Opcode kind, std::string_view payload) RELIEVO_RT;
  [[nodiscard]] Result<bool> putText(PortBytes text, bool quiet) RELIEVO_RT;
  [[nodiscard]] Result<bool> flush() RELIEVO_RT;
  void reply(const Message& control) RELIEVO_RT;
  [[nodiscard]] std::optional<Duration> answered() RELIEVO_RT;
  [[nodiscard]] std::uint32_t randomBits() RELIEVO_RT;

  std::unique_ptr<Wire> wire_;
  std::string host_;
  Clock& clock_;
  FrameReader reader_;
  bool ended_ = false;  // the service said so
  std::uint32_t answered_ = 0;

  std::atomic<bool> turn_{false};  // taken by the sending thread; guards the members below
  std::array<char, 1024> outbox_{};
  std::size_t out_begin_ = 0, out_end_ = 0;
  std::uint64_t random_ = 1;
  std::array<std::uint8_t, 512> quiet_{};
  std::size_t quiet_bytes_ = 0;
  bool quiet_sent_ = false;  // as the last message

  std::atomic<bool> exchanging_{false};
  std::atomic<std::uint32_t> sent_{0};
  std::array<std::atomic<Duration::rep>, kTimes> sent_at_{};  // of the last messages, by number
};

}  // namespace relievo::inverse3
