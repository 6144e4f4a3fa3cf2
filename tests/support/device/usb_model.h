// SPDX-License-Identifier: Apache-2.0
// A USB device in software, spoken to at the level of its transfers: the same model stands behind every transport.
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
  // What an IN transfer brings at this moment; nothing: the device has nothing to say yet (it answers NAK).
  virtual std::optional<UsbPacket> read(MonotonicTime now) = 0;
};

}  // namespace relievo::test
