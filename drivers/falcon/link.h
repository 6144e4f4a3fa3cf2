// SPDX-License-Identifier: Apache-2.0
// The Falcon's USB serial bridge (an FT232B): its two modes, its packets, and loading the firmware through it.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "drivers/usb/usb_port.h"

namespace relievo::falcon {

inline constexpr UsbDeviceId kUsbId{.vendor = 0x0403, .product = 0xCB48, .in_endpoint = 0x81, .out_endpoint = 0x02};

// Every packet from the bridge begins with two status bytes; these bits of the second mean that bytes were lost or
// corrupted on the serial line.
inline constexpr std::size_t kStatusBytes = 2;
inline constexpr std::uint8_t kLineErrors = 0x1E;
inline constexpr std::size_t kMostPayload = kUsbPacketBytes - kStatusBytes;

// A packet's payload; empty if there is none, or if the packet reports errors.
[[nodiscard]] UsbBytes payloadOf(const UsbPacket& packet) RELIEVO_RT;

// For the two functions below: the clock they wait by, and the flag that cancels them within 100 ms.
struct Patience {
  Clock& clock;
  const std::atomic<bool>& cancelled;
};

// True if the firmware answers a packet; false after 100 ms. Cancelled.
[[nodiscard]] Result<bool> firmwareAnswers(UsbPort& port, const Patience& patience);

// Sends the image to the boot loader, which echoes every byte. One try takes about 3 s. Users report that the first
// often fails, so the caller should open the port again and retry. Leaves the bridge in run mode.
// Corrupt: a wrong echo. Timeout: no answer. Cancelled.
[[nodiscard]] Result<void> loadFirmware(UsbPort& port, const std::vector<std::uint8_t>& image,
                                        const Patience& patience);

}  // namespace relievo::falcon
