// SPDX-License-Identifier: Apache-2.0
// A simulated haptic device: a mass with dry friction, sampled and driven in ticks, held by a simulated hand.
#pragma once

#include <memory>

#include "drivers/sim/hand_path.h"
#include "hal/device_profile.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

// Each `read` advances hand and device to clock.now(), at most by 20 ms, so that on a ManualClock the same calls give
// the same positions to the last bit. Each force acts `delay_ticks` writes later and is held until the next one, as by
// a real amplifier, for 20 ms at most. Its max_stiffness_n_per_mm is four fifths of the lower of DeviceProfile's two
// bounds, and at most most_stiffness_n_per_mm. The hand's path begins with `start` and pauses while the device is
// stopped. `clock` must outlive the device.
[[nodiscard]] std::unique_ptr<HapticDevice> makeSimHaptic(const DeviceProfile& profile, HandPath path,
                                                          const Clock& clock);

}  // namespace relievo
