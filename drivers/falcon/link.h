// SPDX-License-Identifier: Apache-2.0
// The Falcon's serial bridge (an FT232B): its two modes, and the bytes that come through it.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "drivers/usb/usb_port.h"

namespace relievo::falcon {

inline constexpr UsbDeviceId kUsbId{.vendor = 0x0403, .product = 0xCB48, .in_endpoint = 0x81, .out_endpoint = 0x02};

// Every packet from the bridge begins with two bytes of its own; in the second, these bits tell that bytes were lost or
// broken on the serial side.
inline constexpr std::size_t kStatusBytes = 2;
inline constexpr std::uint8_t kLineErrors = 0x1E;
inline constexpr std::size_t kMostPayload = kUsbPacketBytes - kStatusBytes;

// What a packet carries; empty when there is nothing, or when it says that it is broken.
[[nodiscard]] UsbBytes payloadOf(const UsbPacket& packet) RELIEVO_RT;

// Slow line, for the boot loader: 9600 baud, 8N1, DTR raised, latency timer 16 ms (with 1 ms its checks fail).
[[nodiscard]] Result<void> setBootMode(UsbPort& port);
// Fast line, for the firmware: 1.5 MBd, latency timer 1 ms, both directions emptied.
[[nodiscard]] Result<void> setRunMode(UsbPort& port);

// What the two verbs of set-up wait by, and what calls them off within 100 ms.
struct Patience {
  Clock& clock;
  const std::atomic<bool>& cancelled;
};

// True when the firmware answers a packet; takes 100 ms at most where it does not. Cancelled.
[[nodiscard]] Result<bool> firmwareAnswers(UsbPort& port, const Patience& patience);

// Hands the image to the boot loader, which echoes every byte. One try of about 3 s: users report that the first one
// often fails, so that the caller opens the port anew and tries again. Leaves the bridge in run mode.
// Corrupt: a wrong echo. Timeout: no answer. Cancelled.
[[nodiscard]] Result<void> loadFirmware(UsbPort& port, const std::vector<std::uint8_t>& image,
                                        const Patience& patience);

}  // namespace relievo::falcon
