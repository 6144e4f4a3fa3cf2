// SPDX-License-Identifier: Apache-2.0
// The Novint Falcon as a haptic device.
#pragma once

#include <memory>
#include <string>

#include "drivers/falcon/motors.h"
#include "drivers/usb/usb_port.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

struct FalconConfig {
  // The maker's firmware image, from the SDK that came with the device; its licence forbids shipping it. Not needed if
  // the device runs it already, which it does until it loses power.
  std::string firmware_path;
  double counts_per_nm = falcon::kDefaultCountsPerNm;
  bool watchdog_thread = true;  // false: only `read` checks, for simulated time
};

// `home` waits until the user has moved the grip through its range, or until `cancel` or Lost. The light ring is red
// until then, green afterwards. The force fades in over half a second after `start`.
// Safety: the watchdog sends zero 20 ms after the last `write`; so do `stop`, `close`, the destructor and
// quietenAllUsbDevices(). A device that answers nothing for 100 ms is Lost.
// Frame: x right, y up, z toward the user; z is about 75 to 175 mm.
[[nodiscard]] std::unique_ptr<HapticDevice> makeFalcon(const FalconConfig& config, std::unique_ptr<UsbPort> port,
                                                       Clock& clock);
// For the first Falcon that libusb finds.
[[nodiscard]] std::unique_ptr<HapticDevice> makeFalcon(const FalconConfig& config, Clock& clock);

}  // namespace relievo
