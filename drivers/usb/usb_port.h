// SPDX-License-Identifier: Apache-2.0
// A thin port to one USB device with one interface, with only what a haptic driver needs. Tests put a model of the
// device behind it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "drivers/force/force_port.h"
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
using UsbBytes = PortBytes;

// A received packet: the first `bytes` of `data`.
struct UsbPacket {
  std::array<std::uint8_t, kUsbPacketBytes> data{};
  std::size_t bytes = 0;
  [[nodiscard]] UsbBytes view() const RELIEVO_RT { return UsbBytes(data).first(bytes); }
};

// Calls are on the owner's thread, except that `take` and `post` are on one real-time thread, only between
// `startExchange` and `stopExchange`; they never wait. `control`, `send` and `receive` are for set-up, outside of an
// exchange, and may wait. Every call returns Lost once the device has gone.
class UsbPort : public ForcePort {
 public:
  // Opens the first device with one of its ids that no other program uses, and claims interface 0. NotFound,
  // PermissionDenied, Unsupported (in use).
  [[nodiscard]] virtual Result<void> open() = 0;
  virtual void close() noexcept = 0;

  // Sends a vendor request without data to the device.
  [[nodiscard]] virtual Result<void> control(std::uint8_t request, std::uint16_t value) = 0;
  [[nodiscard]] virtual Result<void> send(UsbBytes bytes, Duration timeout) = 0;
  // Returns one packet; Timeout if none came.
  [[nodiscard]] virtual Result<UsbPacket> receive(Duration timeout) = 0;

  // The oldest received packet not yet taken; empty if there is none.
  [[nodiscard]] virtual Result<UsbPacket> take() RELIEVO_RT = 0;
};

// A port by libusb to a device with any of the ids. Allocates nothing and takes no lock between startExchange and
// stopExchange.
[[nodiscard]] std::unique_ptr<UsbPort> makeLibusbPort(std::vector<UsbDeviceId> ids);

// Whether a device with one of the ids is plugged in; it is not opened.
[[nodiscard]] bool usbDeviceIsThere(std::span<const UsbDeviceId> ids);

// Stops the motors of every device that is in an exchange. For handlers of fatal signals: async-signal-safe. Nothing
// posted later in that exchange is sent, whatever other threads do until the process ends.
void quietenAllUsbDevices() noexcept;

}  // namespace relievo
