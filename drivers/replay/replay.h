// SPDX-License-Identifier: Apache-2.0
// A haptic device that moves as a recorded one did.
#pragma once

#include <memory>

#include "drivers/replay/recording.h"
#include "hal/haptic_device.h"

namespace relievo {

// The n-th `read` since `open` answers the n-th tick of the recording, to the last bit; a tick at which the device did
// not answer is an Io error. After the last tick it stays there. It says that it is the recorded device, so that forces
// and scene positions come out the same. Forces are taken and push nobody; it cannot be lost.
[[nodiscard]] std::unique_ptr<HapticDevice> makeReplay(Recording recording);

}  // namespace relievo
