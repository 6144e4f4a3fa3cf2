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
  bool watchdog_thread = true;  // false: `read` looks alone, for simulated time
};

// The encoders count from wherever the arm was when its power came on. `home` therefore needs the arm in the pose in
// which it is calibrated (its rest, as the description's calibrate_enc says; a WoodenHaptics: upper link upright, lower
// link level, straight ahead), waits until it has been still there for half a second, until `cancel` or Lost, and then
// tells the board what its encoders should show. A board that does not know that command is corrected here.
// The force fades in over half a second after `start`. The button is the grip's.
// Safety: the watchdog sends zero 20 ms after the last `write`, and the board by itself after 500 ms; so do `stop`,
// `close`, the destructor and quietenAllUsbDevices(). A device that answers nothing for 100 ms is Lost. Gravity is not
// compensated.
// Frame: x right, y up, z toward the user, origin in the middle of the workspace (see polhem::Arm).
[[nodiscard]] std::unique_ptr<HapticDevice> makePolhem(const PolhemConfig& config, std::unique_ptr<UsbPort> port,
                                                       Clock& clock);
// On the first one that libusb finds, of either board.
[[nodiscard]] std::unique_ptr<HapticDevice> makePolhem(const PolhemConfig& config, Clock& clock);

}  // namespace relievo
