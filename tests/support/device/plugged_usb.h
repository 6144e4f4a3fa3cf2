// SPDX-License-Identifier: Apache-2.0
// A model of a USB device, plugged into the machine that the test runs on: the real libusb finds it.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "tests/support/device/usb_model.h"

namespace relievo::test {

class PluggedUsb {
 public:
  virtual ~PluggedUsb() = default;
  virtual void plug() = 0;
  virtual void unplug() = 0;
  // As `unplug`, but by itself after so many requests from now on (0: not); call `unplug` when it has happened.
  virtual void unplugAfter(int requests) = 0;
  // The device takes no command until `takesAgain`: transfers to it wait.
  virtual void takesNothing() = 0;
  virtual void takesAgain() = 0;
  // Take it to look at the model.
  [[nodiscard]] virtual std::mutex& lock() = 0;
  // Requests of the kernel's interface that a transport does not know: a kernel has none.
  [[nodiscard]] virtual int unknownRequests() const { return 0; }
};

// Whether umockdev's library was loaded first.
[[nodiscard]] bool machineIsMocked();

// By umockdev where its library was loaded first, by the kernel's virtual host controller (vhci_hcd) where that is
// there; null where neither is. `model` is called on a thread of the result's, with its lock held, at the system's
// monotonic time.
[[nodiscard]] std::unique_ptr<PluggedUsb> plugIn(UsbModel& model, const UsbDeviceId& id);
inline constexpr const char* kNoPlug = "neither umockdev's library nor the module vhci_hcd is loaded";

// The descriptors of a full-speed device with one interface and the two endpoints of the id.
[[nodiscard]] std::vector<std::uint8_t> deviceDescriptor(const UsbDeviceId& id);
[[nodiscard]] std::vector<std::uint8_t> configurationDescriptor(const UsbDeviceId& id);

}  // namespace relievo::test
