// SPDX-License-Identifier: Apache-2.0
// A haptic device that is computed: a mass with dry friction, sampled and driven in ticks, held by a computed
// hand.
#pragma once

#include <memory>

#include "drivers/sim/hand_path.h"
#include "hal/device_profile.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

// Time is the clock's: each `read` moves hand and device on to clock.now(), at most by 20 ms, so that on a
// ManualClock the same calls give the same positions to the last bit. The force of the last write but
// `delay_ticks` is held until the next one, as by a real amplifier, and for 20 ms at most. The stiffness that it says
// it holds is four fifths of the lower bound, and none above its parts' own. The hand's path
// begins with `start` and stands still while the device is stopped. `clock` must outlive the device.
[[nodiscard]] std::unique_ptr<HapticDevice> makeSimHaptic(const DeviceProfile& profile, HandPath path,
                                                          const Clock& clock);

}  // namespace relievo
