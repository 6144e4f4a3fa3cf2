// SPDX-License-Identifier: Apache-2.0
// A haptic device that plays back a recorded session.
#pragma once

#include <memory>

#include "drivers/replay/recording.h"
#include "hal/haptic_device.h"

namespace relievo {

// The n-th `read` since `open` returns the n-th tick of the recording, to the last bit; a tick at which the device did
// not answer is an Io error. After the last tick the position stays. Its capabilities are those of the recorded device,
// so that forces and scene positions come out the same. It ignores forces and cannot be lost.
[[nodiscard]] std::unique_ptr<HapticDevice> makeReplay(Recording recording);

}  // namespace relievo
