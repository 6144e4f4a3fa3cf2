// SPDX-License-Identifier: Apache-2.0
// The devices whose motors must be stopped before the process ends, however it ends.
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
  std::atomic<bool> silenced = false;  // by quietenAllUsbDevices: no command follows any more
};

// Takes back the command that the device has not taken yet, then one blocking transfer, 20 ms at most. False when the
// device did not take it. Async-signal-safe.
bool sendQuiet(const QuietEntry& entry) noexcept;

// Listed while it lives. `entry` must outlive the listing. A process has few devices: past the fourth none is listed.
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
