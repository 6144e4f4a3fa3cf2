// SPDX-License-Identifier: Apache-2.0
// Axes and keys are as the kernel's Documentation/input/gamepad.rst lays them out, and as drivers of joysticks and
// wheels do.
#include "drivers/gamepad/pad_controls.h"

#include <algorithm>
#include <string_view>

namespace relievo {
namespace {

constexpr double kKeyPull = 0.6;
constexpr double kUpperEnd = 0.75;  // from here on a pedal that is first heard of stands at its upper end

// Some wheels have one range for all of their axes (hid-fanatecff: 0 to 65535), but every driver of one calls it so.
bool isCalledWheel(const std::string& name) noexcept {
  constexpr std::string_view kWheel = "wheel";
  const auto same = [](char a, char b) { return a == b || a == b - 'a' + 'A'; };
  return !std::ranges::search(name, kWheel, same).empty();
}

bool hasWheelsAxes(const PadFacts& facts) noexcept {
  const input_absinfo &x = facts.ranges[ABS_X], &y = facts.ranges[ABS_Y];
  if (!facts.axes.has(ABS_Y) || facts.keys.has(BTN_WHEEL) || isCalledWheel(facts.name)) return true;
  return x.minimum != y.minimum || x.maximum != y.maximum;
}

bool hasStick(const PadFacts& facts) noexcept {
  const input_absinfo& x = facts.ranges[ABS_X];
  return facts.axes.has(ABS_X) && x.minimum < x.maximum;
}

bool hasForce(const PadFacts& facts) noexcept {
  const bool pushes = facts.forces.has(FF_RUMBLE) || facts.forces.has(FF_CONSTANT) || facts.forces.has(FF_SPRING);
  return pushes && facts.effects_at_once > 0;
}

}  // namespace

bool isPad(const PadFacts& facts) noexcept {
  return hasStick(facts) && hasForce(facts);
}

bool isPadWithoutForce(const PadFacts& facts) noexcept {
  const bool buttons = facts.keys.has(BTN_GAMEPAD) || facts.keys.has(BTN_JOYSTICK);
  const input_absinfo& down = facts.ranges[ABS_Y];
  const bool two_axes = facts.axes.has(ABS_Y) && down.minimum < down.maximum;
  return (facts.keys.has(BTN_WHEEL) || (buttons && two_axes)) && hasStick(facts) && !hasForce(facts);
}

double PadControls::Axis::share() const RELIEVO_RT {
  return std::clamp((value - low) / (high - low), 0.0, 1.0);
}

PadControls::Axis PadControls::axisOf(const PadFacts& facts, unsigned code) noexcept {
  const input_absinfo& range = facts.ranges[code];
  if (!facts.axes.has(code) || range.minimum >= range.maximum) return {};
  Axis axis{.code = code,
            .low = static_cast<double>(range.minimum),
            .high = static_cast<double>(range.maximum),
            .value = static_cast<double>(range.value),
            .heard = range.value != 0};
  return axis;
}

PadControls::PadControls(const PadFacts& facts) noexcept : wheel_(hasWheelsAxes(facts)) {
  stick_ = {axisOf(facts, ABS_X), axisOf(facts, wheel_ ? ABS_HAT0Y : ABS_Y)};
  findTriggers(facts);
  findKeys(facts.keys);
}

bool PadControls::mayPress(const PadFacts& facts, unsigned code) const noexcept {
  const bool second_stick = facts.axes.has(ABS_RX) && facts.axes.has(ABS_RY);
  const bool pushes = facts.forces.has(FF_CONSTANT) || facts.forces.has(FF_SPRING);
  switch (code) {
    case ABS_GAS:
    case ABS_BRAKE:
      return true;
    case ABS_HAT2X:
    case ABS_HAT2Y:
      return facts.ranges[code].minimum >= 0;  // else a hat or a stick
    case ABS_Y:
      return wheel_;
    default:
      return wheel_ || (second_stick && !pushes);
  }
}

void PadControls::findTriggers(const PadFacts& facts) noexcept {
  std::size_t count = 0;
  for (const unsigned code : {ABS_GAS, ABS_BRAKE, ABS_HAT2X, ABS_HAT2Y, ABS_Z, ABS_RZ, ABS_Y}) {
    Axis axis = mayPress(facts, code) ? axisOf(facts, code) : Axis{};
    if (axis.code == ABS_CNT) continue;
    axis.inverted = wheel_ && axis.heard && axis.share() > kUpperEnd;
    triggers_[count++] = axis;
  }
}

void PadControls::findKeys(const InputKeys& keys) noexcept {
  const bool analog = triggers_[0].code != ABS_CNT;
  for (const unsigned key : {BTN_TR2, BTN_TR, BTN_TRIGGER, BTN_SOUTH}) {
    if (!analog && press_key_ == KEY_CNT && keys.has(key)) press_key_ = key;
  }
  std::size_t count = 0;  // a gamepad's own buttons are the remote control's
  for (const unsigned key : {BTN_THUMB, BTN_THUMB2, BTN_TRIGGER, BTN_TOP}) {
    if (count < button_keys_.size() && key != press_key_ && keys.has(key)) button_keys_[count++] = key;
  }
}

void PadControls::take(const input_event& event) RELIEVO_RT {
  if (event.type == EV_KEY) down_.put(event.code, event.value != 0);
  if (event.type == EV_ABS) learn(event.code, event.value, true);
}

void PadControls::learn(unsigned code, std::int32_t value, bool reported) RELIEVO_RT {
  for (Axis& axis : stick_) {
    if (axis.code != code) continue;
    axis.value = value;
    axis.heard = axis.heard || reported;
  }
  for (Axis& axis : triggers_) {
    if (axis.code != code) continue;
    axis.value = value;
    if (reported && !axis.heard) axis.inverted = wheel_ && axis.share() > kUpperEnd;
    axis.heard = axis.heard || reported;
  }
}

bool PadControls::uses(unsigned code) const RELIEVO_RT {
  const auto is = [code](const Axis& axis) { return axis.code == code; };
  return code < ABS_CNT && (std::ranges::any_of(stick_, is) || std::ranges::any_of(triggers_, is));
}

glm::dvec2 PadControls::stick() const RELIEVO_RT {
  const auto place = [](const Axis& axis) { return axis.heard ? 2 * axis.share() - 1 : 0.0; };
  return {place(stick_[0]), -place(stick_[1])};  // evdev's y counts toward the user
}

double PadControls::pull() const RELIEVO_RT {
  double most = down_.has(press_key_) ? kKeyPull : 0;
  for (const Axis& axis : triggers_) {
    if (!axis.heard) continue;
    most = std::max(most, axis.inverted ? 1 - axis.share() : axis.share());
  }
  return most;
}

std::uint32_t PadControls::buttons() const RELIEVO_RT {
  return (down_.has(button_keys_[0]) ? 1U : 0U) | (down_.has(button_keys_[1]) ? 2U : 0U);
}

}  // namespace relievo
