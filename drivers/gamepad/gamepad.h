// SPDX-License-Identifier: Apache-2.0
// A gamepad, a joystick or a wheel as a haptic device, over the kernel's evdev and force feedback.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/gamepad/pad_port.h"
#include "hal/haptic_device.h"
#include "platform/clock.h"

namespace relievo {

struct GamepadConfig {
  bool effect_thread = true;  // false: effects are sent in the tick, for simulated time
};

// Behaviour follows from what the kernel reports of the device. Without motors on its stick (a gamepad), the stick
// moves the finger, at up to 100 mm/s, and rumble signals the force (see pad_effects.h). With them (a joystick, a
// wheel), the stick's position is the finger's, and the motors push along its axes; the rest of the force goes to the
// rumble, if there is one. A trigger or a pedal presses: its travel sets how deep the finger wants to go, against the
// surface (see pad_finger.h). The first button of a joystick or a wheel is its main one (bit 0), the second its clutch
// (bit 1); a gamepad's are keys (drivers/evdev/pad_keys.h).
//
// Uploading an effect may block, so a thread of its own does it, every 4 ms (see EffectPlayer). It stops all effects
// when no force comes for 20 ms. A wheel's own centring is off while the device runs; since the kernel cannot report
// its previous strength, it is set to full strength at the end.
[[nodiscard]] std::unique_ptr<HapticDevice> makeGamepad(std::unique_ptr<PadPort> port, Clock& clock,
                                                        const GamepadConfig& config = {});
// `path`: see makeEvdevPadPort.
[[nodiscard]] std::unique_ptr<HapticDevice> makeGamepad(std::string path, Clock& clock);

// Each gamepad, joystick and wheel, with what it can do, or why it cannot be used; if there is none, that, with an
// empty path.
struct PadSeen {
  std::string path;
  bool there = false;
  std::string state;
};
[[nodiscard]] std::vector<PadSeen> lookAtGamepads();

}  // namespace relievo
