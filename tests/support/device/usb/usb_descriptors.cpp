// SPDX-License-Identifier: Apache-2.0
// Builds the descriptors of a model.
#include "tests/support/device/usb/plugged_usb.h"

namespace relievo::test {

std::vector<std::uint8_t> deviceDescriptor(const UsbDeviceId& id) {
  const auto low = [](std::uint16_t word) { return static_cast<std::uint8_t>(word & 0xFF); };
  const auto high = [](std::uint16_t word) { return static_cast<std::uint8_t>(word >> 8); };
  // No strings, since no driver reads them.
  return {18, 1, 0, 2, 0, 0, 0, 8, low(id.vendor), high(id.vendor), low(id.product), high(id.product),
          0,  6, 0, 0, 0, 1};
}

std::vector<std::uint8_t> configurationDescriptor(const UsbDeviceId& id) {
  const std::uint8_t kind = id.interrupt ? 3 : 2;
  const std::uint8_t interval = id.interrupt ? 1 : 0;
  constexpr std::uint8_t kVendorClass = 0xFF, kBusPowered = 0xA0, k90Milliamps = 45;
  return {9,
          2,
          32,
          0,
          1,
          1,
          0,
          kBusPowered,
          k90Milliamps,
          9,
          4,
          0,
          0,
          2,
          kVendorClass,
          kVendorClass,
          kVendorClass,
          0,
          7,
          5,
          id.in_endpoint,
          kind,
          kUsbPacketBytes,
          0,
          interval,
          7,
          5,
          id.out_endpoint,
          kind,
          kUsbPacketBytes,
          0,
          interval};
}

}  // namespace relievo::test
