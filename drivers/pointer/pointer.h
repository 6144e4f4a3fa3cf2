// SPDX-License-Identifier: Apache-2.0
// A mouse in place of a haptic device, for who has none: it points, presses and shows what would be felt.
#pragma once

#include <memory>
#include <string>

#include "drivers/pointer/mouse_port.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

// The picture plane by the mouse, 0.1 mm a count (1000 counts an inch: some four times the hand's way). The wheel moves
// the finger 2 mm a notch, forward is away from the viewer. The left button, while it is held, presses: the finger goes
// toward the surface at 80 mm/s, slower the harder it is pushed back, and rests where that is 2 N; let go, it comes
// back at that speed. The middle button is the device's main button (bit 0), the right one its clutch (bit 1); the left
// one is none, since it presses. Every step is smoothed with a time constant of 10 ms, about the time between two
// reports.
//
// Over a window it points at a place: the finger is where the mouse is, and the picture plane is the window's.
//
// It cannot push: a force is kept for 20 ms to press against, and nobody feels it. Unplugged it is Lost. The mouse is
// not taken from a desktop that uses it as well.
[[nodiscard]] std::unique_ptr<HapticDevice> makePointer(std::unique_ptr<MousePort> port, const Clock& clock);
// `path`: see makeEvdevPort.
[[nodiscard]] std::unique_ptr<HapticDevice> makePointer(std::string path, const Clock& clock);
[[nodiscard]] std::unique_ptr<HapticDevice> makePointer(std::shared_ptr<WindowInput> window, const Clock& clock);

}  // namespace relievo
