// SPDX-License-Identifier: Apache-2.0
// A thin port to the stream of bytes between here and the Haply Inverse service. Tests put an emulator behind it.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo::inverse3 {

struct Address {
  static constexpr std::uint16_t kUsualPort = 10001;

  std::string host = "localhost";
  std::uint16_t port = kUsualPort;
  // Of the service's versions before 3.1, whose messages are not spoken; unset: that beside the usual `port`.
  std::optional<std::uint16_t> older_port;

  // "HOST", "HOST:PORT", "[IPv6]:PORT"; nullopt for anything else.
  [[nodiscard]] static std::optional<Address> parse(const std::string& text);
  [[nodiscard]] std::string text() const;  // "HOST:PORT"
};

// `open` and `close` on the owner's thread, `receive` and `send` on one thread at a time, `cut` on any one while it is
// open.
class Wire {
 public:
  virtual ~Wire() = default;

  // NotFound: nobody listens there; the message differs if somebody does at the older port. Timeout; Cancelled within
  // 100 ms after `cancelled` is set.
  [[nodiscard]] virtual Result<void> open(const std::atomic<bool>& cancelled) = 0;
  virtual void close() noexcept = 0;

  // Never wait. The number of bytes, 0 if there are none or none can be taken now; Lost.
  [[nodiscard]] virtual Result<std::size_t> receive(std::span<char> to) RELIEVO_RT = 0;
  [[nodiscard]] virtual Result<std::size_t> send(std::span<const char> bytes) RELIEVO_RT = 0;

  // Ends the connection for both sides; whatever is called later returns Lost.
  virtual void cut() noexcept = 0;
};

[[nodiscard]] std::unique_ptr<Wire> makeTcpWire(Address address);

}  // namespace relievo::inverse3
