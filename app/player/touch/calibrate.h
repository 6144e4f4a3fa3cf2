// SPDX-License-Identifier: Apache-2.0
// Measures a haptic device's real force with a spring scale.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "hal/haptic_device.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// Pushes the handle toward the user with 2, 3 and 4 N in turn (as far as the device can), each until `readScale`
// returns the reading of a spring scale, N; nullopt: the user has given up. Returns measured / requested force, the
// mean over the readings: a device configured with c counts per newton-metre really has c divided by that.
// The device must be open; it is homed here and always closed at the end. InvalidArgument for readings that are not a
// force or do not agree within 20 %; Cancelled. Owner's thread; with `own_thread` false the ticks run before
// `readScale`, for simulated time.
using ReadScale = std::function<std::optional<double>(double asked_n)>;
[[nodiscard]] Result<double> measureStrength(HapticDevice& device, const ReadScale& readScale, Clock& clock,
                                             bool own_thread = true);

// Asks the user at the terminal for the scale's reading; nullopt for an empty line, or none.
[[nodiscard]] std::optional<double> askForReading(double asked_n);
// Parses what the user has typed: a number, with a point or a comma, with or without "N" behind it.
[[nodiscard]] std::optional<double> newtonsIn(std::string line);

}  // namespace relievo
