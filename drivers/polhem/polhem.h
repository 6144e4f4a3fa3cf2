// SPDX-License-Identifier: Apache-2.0
// Arms of the Polhem and WoodenHaptics family as haptic devices.
#pragma once

#include <memory>

#include "drivers/polhem/description.h"
#include "drivers/usb/usb_port.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

struct PolhemConfig {
  polhem::Description description = polhem::kWoodenHaptics2019;
  bool watchdog_thread = true;  // false: only `read` checks, for simulated time
};

// The encoders count from the arm's pose at power-on. `home` therefore needs the arm in its calibration pose (at rest,
// where the counts are the description's calibrate_enc; for a WoodenHaptics: upper link upright, lower link level,
// straight ahead). It waits until the arm has been still there for half a second, or until `cancel` or Lost, then sends
// these counts to the board. If the board does not know that command, the driver adds the offset itself.
// The force fades in over half a second after `start`. The button is the grip's.
// Safety: the watchdog sends zero 20 ms after the last `write`, and the board by itself after 500 ms; so do `stop`,
// `close`, the destructor and quietenAllUsbDevices(). A device that answers nothing for 100 ms is Lost. Gravity is not
// compensated.
// Frame: x right, y up, z toward the user, origin in the middle of the workspace (see polhem::Arm).
[[nodiscard]] std::unique_ptr<HapticDevice> makePolhem(const PolhemConfig& config, std::unique_ptr<UsbPort> port,
                                                       Clock& clock);
// For the first arm that libusb finds, with either board.
[[nodiscard]] std::unique_ptr<HapticDevice> makePolhem(const PolhemConfig& config, Clock& clock);

}  // namespace relievo
