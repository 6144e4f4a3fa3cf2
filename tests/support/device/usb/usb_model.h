// SPDX-License-Identifier: Apache-2.0
// A simulated USB device at the level of its transfers: every transport can use the same model.
#pragma once

#include <optional>

#include "drivers/usb/usb_port.h"

namespace relievo::test {

// One thread at a time. `now` never goes back.
class UsbModel {
 public:
  virtual ~UsbModel() = default;
  virtual void control(std::uint8_t request, std::uint16_t value, MonotonicTime now) = 0;
  virtual void write(UsbBytes bytes, MonotonicTime now) = 0;
  // The result of an IN transfer now; nullopt if the device has no data (it answers NAK).
  virtual std::optional<UsbPacket> read(MonotonicTime now) = 0;
};

}  // namespace relievo::test
