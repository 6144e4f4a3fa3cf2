// SPDX-License-Identifier: Apache-2.0
// Finds out how strong a haptic device really is, with a spring scale.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "hal/haptic_device.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// Pushes the handle toward the user with 2, 3 and 4 N in turn (as far as the device has them), each for as long as
// `readScale` takes to tell what a spring scale shows, N; nothing: the user has given up. Answers shown / asked force,
// the mean over the readings: a device that is set to c counts per newton-metre has c divided by that in truth.
// The device is open; it is homed here and closed in the end, whatever happens. InvalidArgument for readings that are
// no force or do not agree within 20 %; Cancelled. Owner's thread; `own_thread` false: the ticks run before
// `readScale`, for simulated time.
using ReadScale = std::function<std::optional<double>(double asked_n)>;
[[nodiscard]] Result<double> measureStrength(HapticDevice& device, const ReadScale& readScale, Clock& clock,
                                             bool own_thread = true);

// What somebody has typed: a number, with a point or a comma, and "N" behind it or not.
[[nodiscard]] std::optional<double> newtonsIn(std::string line);

}  // namespace relievo
