// SPDX-License-Identifier: Apache-2.0
// The part of a gamepad that is a remote control: its buttons, its d-pad and its second stick.
#pragma once

#include <linux/input.h>

#include <cstdint>
#include <vector>

#include "drivers/evdev/key_hold.h"

struct libevdev;

namespace relievo {

// A gamepad by the kernel's Documentation/input/gamepad.rst. A wheel with such buttons is none: its hat moves the
// finger. It has BTN_WHEEL, or a pedal's range on ABS_Y.
[[nodiscard]] bool isGamepad(const libevdev* device) noexcept;

// The first stick and the triggers belong to the finger (drivers/gamepad), pressed or turned, and give no keys. A d-pad
// that is a hat gives BTN_DPAD_..; the second stick gives the volume's keys, as in Kodi: its y is ABS_RY, or ABS_RZ
// beside ABS_Z on a pad without the former (over Bluetooth).
class PadKeys {
 public:
  PadKeys() = default;
  explicit PadKeys(const libevdev* device);

  void take(const input_event& event, KeyHold& keys, MonotonicTime now);

 private:
  struct Axis {
    unsigned code;
    std::uint16_t at_low, at_high;  // keys
    int low = 0, high = 0;
    std::uint16_t down = KEY_RESERVED;  // which of both is pressed
    [[nodiscard]] std::uint16_t keyAt(int value) const noexcept;
  };
  std::vector<Axis> axes_;
  unsigned press_key_ = KEY_RESERVED;  // without a trigger that is an axis it presses the finger in (PadControls)
};

}  // namespace relievo
