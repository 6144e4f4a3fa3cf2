// SPDX-License-Identifier: Apache-2.0
// A thin port to one USB device with one interface: what a haptic driver needs of a bus, and no more. A test stands a
// model of the device behind it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "platform/clock.h"
#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo {

struct UsbDeviceId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint8_t in_endpoint = 0x81;
  std::uint8_t out_endpoint = 0x02;
  bool interrupt = false;  // else bulk
};

inline constexpr std::size_t kUsbPacketBytes = 64;  // of a full-speed endpoint
using UsbBytes = std::span<const std::uint8_t>;

// A packet that arrived: `bytes` of `data`.
struct UsbPacket {
  std::array<std::uint8_t, kUsbPacketBytes> data{};
  std::size_t bytes = 0;
  [[nodiscard]] UsbBytes view() const RELIEVO_RT { return UsbBytes(data).first(bytes); }
};

// `open` to `close` on the owner's thread. `control`, `send` and `receive` are for set-up and wait; between
// `startExchange` and `stopExchange` they are not called, and one thread, the real-time one, calls `take` and `post`,
// which never wait. Every verb answers Lost once the device has gone.
class UsbPort {
 public:
  virtual ~UsbPort() = default;

  // Opens the first device of its ids that nobody else has, and claims interface 0. NotFound, PermissionDenied,
  // Unsupported (somebody has it).
  [[nodiscard]] virtual Result<void> open() = 0;
  virtual void close() noexcept = 0;

  // A vendor request without data, to the device.
  [[nodiscard]] virtual Result<void> control(std::uint8_t request, std::uint16_t value) = 0;
  [[nodiscard]] virtual Result<void> send(UsbBytes bytes, Duration timeout) = 0;
  // One packet; Timeout when none came.
  [[nodiscard]] virtual Result<UsbPacket> receive(Duration timeout) = 0;

  // `quiet` is what `quieten` sends: the command that stops the motors.
  [[nodiscard]] virtual Result<void> startExchange(UsbBytes quiet) = 0;
  // The oldest packet that has arrived and was not taken; empty when there is none.
  [[nodiscard]] virtual Result<UsbPacket> take() RELIEVO_RT = 0;
  // Sends a packet. False when the one before is still on its way: then this one is not sent.
  [[nodiscard]] virtual Result<bool> post(UsbBytes bytes) RELIEVO_RT = 0;
  virtual void stopExchange() noexcept = 0;

  // Takes back what was posted and has not gone out, sends the quiet packet and waits for it, 20 ms at most. False when
  // the device did not take it. Any thread, while an exchange runs.
  virtual bool quieten() noexcept = 0;
};

// Through libusb, to a device of any of the ids. Allocates nothing and takes no lock between startExchange and
// stopExchange.
[[nodiscard]] std::unique_ptr<UsbPort> makeLibusbPort(std::vector<UsbDeviceId> ids);

// Quietens every device that is in an exchange, for a handler of a fatal signal: async-signal-safe. Nothing that is
// posted in that exchange goes out any more, whatever the other threads do until they are gone.
void quietenAllUsbDevices() noexcept;

}  // namespace relievo
