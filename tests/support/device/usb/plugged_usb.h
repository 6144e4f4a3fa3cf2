// SPDX-License-Identifier: Apache-2.0
// A model of a USB device that is plugged into the machine virtually, so that the real libusb finds it.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "tests/support/device/usb/usb_model.h"

namespace relievo::test {

class PluggedUsb {
 public:
  virtual ~PluggedUsb() = default;
  virtual void plug() = 0;
  virtual void unplug() = 0;
  // Unplugs the device after that many more requests (0: never); call `unplug` after it has happened.
  virtual void unplugAfter(int requests) = 0;
  // The device accepts no command until `takesAgain`: transfers to it wait.
  virtual void takesNothing() = 0;
  virtual void takesAgain() = 0;
  // Hold this lock to access the model.
  [[nodiscard]] virtual std::mutex& lock() = 0;
  // The number of kernel requests that the transport does not support; 0 with a real kernel.
  [[nodiscard]] virtual int unknownRequests() const { return 0; }
};

// True if umockdev's library is preloaded.
[[nodiscard]] bool machineIsMocked();

// Uses umockdev if its library is preloaded, else the kernel's virtual host controller (vhci_hcd); null without both.
// `model` is called on a thread of the result, with its lock held, at the system's monotonic time.
[[nodiscard]] std::unique_ptr<PluggedUsb> plugIn(UsbModel& model, const UsbDeviceId& id);
inline constexpr const char* kNoPlug = "neither umockdev's library nor the module vhci_hcd is loaded";

// The descriptors of a full-speed device with one interface and the two endpoints of the id.
[[nodiscard]] std::vector<std::uint8_t> deviceDescriptor(const UsbDeviceId& id);
[[nodiscard]] std::vector<std::uint8_t> configurationDescriptor(const UsbDeviceId& id);

}  // namespace relievo::test
