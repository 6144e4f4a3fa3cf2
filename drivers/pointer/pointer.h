// SPDX-License-Identifier: Apache-2.0
// A mouse in place of a haptic device: it points, presses and shows what would be felt.
#pragma once

#include <memory>
#include <string>

#include "drivers/pointer/mouse_port.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

// The mouse moves the finger in the picture plane by 0.1 mm per count (at 1000 counts per inch, about four times the
// hand's motion). The wheel moves it 2 mm per notch; forward is away from the viewer. Holding the left button presses:
// the finger moves toward the surface at 80 mm/s, slower the stronger the force against it, and rests at 2 N. After
// release it returns at that speed. The middle button is the device's main button (bit 0), the right one its clutch
// (bit 1). Motion is smoothed with a time constant of 10 ms, about the time between two reports.
//
// Over a window it is absolute: the finger is where the mouse points, and the picture plane is the window's.
//
// It has no motors: a force only acts against the press, for 20 ms at most. If unplugged, it is Lost. The mouse is not
// grabbed, so a desktop can use it as well.
[[nodiscard]] std::unique_ptr<HapticDevice> makePointer(std::unique_ptr<MousePort> port, const Clock& clock);
// `path`: see makeEvdevPort.
[[nodiscard]] std::unique_ptr<HapticDevice> makePointer(std::string path, const Clock& clock);
[[nodiscard]] std::unique_ptr<HapticDevice> makePointer(std::shared_ptr<WindowInput> window, const Clock& clock);

}  // namespace relievo
