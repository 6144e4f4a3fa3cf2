// SPDX-License-Identifier: Apache-2.0
// Lists the devices whose motors must be stopped when the process ends or crashes.
#pragma once

#include <atomic>
#include <cstdint>

#include "drivers/usb/usb_port.h"

namespace relievo {

struct QuietEntry {
  int fd = -1;  // of the device's usbfs node
  std::uint8_t endpoint = 0;
  std::array<std::uint8_t, kUsbPacketBytes> packet{};
  std::size_t bytes = 0;
  void* command = nullptr;             // the URB that carries the commands
  std::atomic<bool> silenced = false;  // set by quietenAllUsbDevices: no more commands may be sent
};

// Discards the command that is still on its way and sends `packet`, blocking 20 ms at most. False if the device did not
// accept it. Async-signal-safe.
bool sendQuiet(const QuietEntry& entry) noexcept;

// Lists `entry` while this object lives; `entry` must outlive it. At most four devices are listed.
class QuietListing {
 public:
  explicit QuietListing(QuietEntry& entry) noexcept;
  ~QuietListing();
  QuietListing(const QuietListing&) = delete;
  QuietListing& operator=(const QuietListing&) = delete;

 private:
  QuietEntry* entry_;
};

}  // namespace relievo
