// SPDX-License-Identifier: Apache-2.0
// Chooses umockdev or the kernel's virtual host controller.
#include "tests/support/device/usb/plugged_usb.h"

#include "tests/support/device/usb/umockdev_usb.h"
#include "tests/support/device/usb/vhci_usb.h"

namespace relievo::test {

std::unique_ptr<PluggedUsb> plugIn(UsbModel& model, const UsbDeviceId& id) {
  if (machineIsMocked()) return std::make_unique<UmockdevUsb>(model, id);
  if (VhciUsb::available()) return std::make_unique<VhciUsb>(model, id);
  return nullptr;
}

}  // namespace relievo::test
