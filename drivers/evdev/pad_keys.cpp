// SPDX-License-Identifier: Apache-2.0
#include "drivers/evdev/pad_keys.h"

#include <libevdev/libevdev.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace relievo {
namespace {

constexpr double kPressed = 0.6, kReleased = 0.4;  // of an axis's way from its middle

// Not the sticks' and the triggers' own: BTN_THUMBL, BTN_TL2, BTN_TR2.
constexpr std::array kButtons{BTN_SOUTH,   BTN_EAST,      BTN_NORTH,     BTN_WEST,      BTN_TL,
                              BTN_TR,      BTN_SELECT,    BTN_START,     BTN_MODE,      BTN_THUMBR,
                              BTN_DPAD_UP, BTN_DPAD_DOWN, BTN_DPAD_LEFT, BTN_DPAD_RIGHT};

}  // namespace

bool isGamepad(const libevdev* device) noexcept {
  const auto has = [device](unsigned type, unsigned code) { return libevdev_has_event_code(device, type, code) != 0; };
  const bool stick = has(EV_ABS, ABS_Y) &&
                     libevdev_get_abs_minimum(device, ABS_X) == libevdev_get_abs_minimum(device, ABS_Y) &&
                     libevdev_get_abs_maximum(device, ABS_X) == libevdev_get_abs_maximum(device, ABS_Y);
  return has(EV_KEY, BTN_GAMEPAD) && stick && !has(EV_KEY, BTN_WHEEL);
}

PadKeys::PadKeys(const libevdev* device) {
  const auto has = [device](unsigned type, unsigned code) { return libevdev_has_event_code(device, type, code) != 0; };
  const bool second_stick = has(EV_ABS, ABS_RX) && has(EV_ABS, ABS_RY);
  const unsigned volume = !second_stick && has(EV_ABS, ABS_Z) ? ABS_RZ : ABS_RY;
  for (Axis axis : {Axis{ABS_HAT0X, BTN_DPAD_LEFT, BTN_DPAD_RIGHT}, Axis{ABS_HAT0Y, BTN_DPAD_UP, BTN_DPAD_DOWN},
                    Axis{volume, KEY_VOLUMEUP, KEY_VOLUMEDOWN}}) {
    axis.low = libevdev_get_abs_minimum(device, axis.code);
    axis.high = libevdev_get_abs_maximum(device, axis.code);
    const bool touchpad = axis.code != volume && axis.high > 1;    // as of hid-steam
    if (axis.low < axis.high && !touchpad) axes_.push_back(axis);  // one that the device lacks has 0 for both
  }
  const auto presses = [&](unsigned code) { return has(EV_ABS, code) && libevdev_get_abs_minimum(device, code) >= 0; };
  if (has(EV_ABS, ABS_GAS) || has(EV_ABS, ABS_BRAKE) || presses(ABS_HAT2X) || presses(ABS_HAT2Y)) return;
  if (second_stick && (has(EV_ABS, ABS_Z) || has(EV_ABS, ABS_RZ))) return;
  for (const unsigned key : {BTN_TR2, BTN_TR, BTN_TRIGGER, BTN_SOUTH}) {
    if (press_key_ == KEY_RESERVED && has(EV_KEY, key)) press_key_ = key;
  }
}

std::uint16_t PadKeys::Axis::keyAt(int value) const noexcept {
  const double place = 2.0 * (value - low) / (high - low) - 1;
  if (std::abs(place) < (down == KEY_RESERVED ? kPressed : kReleased)) return KEY_RESERVED;
  return place < 0 ? at_low : at_high;
}

void PadKeys::take(const input_event& event, KeyHold& keys, MonotonicTime now) {
  if (event.type == EV_KEY) {
    const bool is_key = std::ranges::find(kButtons, event.code) != kButtons.end();
    if (is_key && event.code != press_key_) keys.take(event.code, event.value, now);
  }
  if (event.type != EV_ABS) return;
  const auto axis = std::ranges::find(axes_, event.code, &Axis::code);
  if (axis == axes_.end()) return;
  const std::uint16_t key = axis->keyAt(event.value);
  if (key == axis->down) return;
  if (axis->down != KEY_RESERVED) keys.take(axis->down, 0, now);
  if (key != KEY_RESERVED) keys.take(key, 1, now);
  axis->down = key;
}

}  // namespace relievo
