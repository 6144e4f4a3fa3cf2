// SPDX-License-Identifier: Apache-2.0
// Axes and keys are as the kernel's Documentation/input/gamepad.rst lays them out, and as drivers of joysticks and
// wheels do.
#include "drivers/gamepad/pad_controls.h"

#include <algorithm>

namespace relievo {
namespace {

constexpr double kKeyPull = 0.6;
constexpr double kUpperEnd = 0.75;  // from here on a pedal that is first heard of stands at its upper end

bool isWheelsAxes(const PadFacts& facts) noexcept {
  const input_absinfo &x = facts.ranges[ABS_X], &y = facts.ranges[ABS_Y];
  if (!facts.axes.has(ABS_Y) || facts.keys.has(BTN_WHEEL)) return true;
  return x.minimum != y.minimum || x.maximum != y.maximum;
}

}  // namespace

bool isPad(const PadFacts& facts) noexcept {
  const input_absinfo& x = facts.ranges[ABS_X];
  const bool pushes = facts.forces.has(FF_RUMBLE) || facts.forces.has(FF_CONSTANT) || facts.forces.has(FF_SPRING);
  return pushes && facts.effects_at_once > 0 && facts.axes.has(ABS_X) && x.minimum < x.maximum;
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
            .value = static_cast<double>(range.value)};
  return axis;
}

PadControls::PadControls(const PadFacts& facts) noexcept : wheel_(isWheelsAxes(facts)) {
  stick_ = {axisOf(facts, ABS_X), axisOf(facts, wheel_ ? ABS_HAT0Y : ABS_Y)};
  findTriggers(facts);
  findKeys(facts.keys);
}

void PadControls::findTriggers(const PadFacts& facts) noexcept {
  const bool second_stick = facts.axes.has(ABS_RX) && facts.axes.has(ABS_RY);
  std::size_t count = 0;
  for (const unsigned code : {ABS_GAS, ABS_BRAKE, ABS_Z, ABS_RZ, ABS_Y}) {
    const bool surely = code == ABS_GAS || code == ABS_BRAKE;
    const bool may = surely || wheel_ || (second_stick && code != ABS_Y);
    Axis axis = may ? axisOf(facts, code) : Axis{};
    if (axis.code == ABS_CNT) continue;
    axis.inverted = wheel_ && axis.share() > kUpperEnd;
    axis.heard = !wheel_ || axis.inverted;
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
  if (event.type == EV_ABS) setAxis(event.code, event.value);
}

void PadControls::setAxis(unsigned code, std::int32_t value) RELIEVO_RT {
  for (Axis& axis : stick_) {
    if (axis.code == code) axis.value = value;
  }
  for (Axis& axis : triggers_) {
    if (axis.code != code) continue;
    axis.value = value;
    if (!axis.heard) axis.inverted = axis.share() > kUpperEnd;
    axis.heard = true;
  }
}

bool PadControls::uses(unsigned code) const RELIEVO_RT {
  const auto is = [code](const Axis& axis) { return axis.code == code; };
  return code < ABS_CNT && (std::ranges::any_of(stick_, is) || std::ranges::any_of(triggers_, is));
}

glm::dvec2 PadControls::stick() const RELIEVO_RT {
  const auto place = [](const Axis& axis) { return axis.code == ABS_CNT ? 0.0 : 2 * axis.share() - 1; };
  return {place(stick_[0]), -place(stick_[1])};  // evdev's y counts toward the user
}

double PadControls::pull() const RELIEVO_RT {
  double most = down_.has(press_key_) ? kKeyPull : 0;
  for (const Axis& axis : triggers_) {
    if (axis.code == ABS_CNT) continue;
    most = std::max(most, axis.inverted ? 1 - axis.share() : axis.share());
  }
  return most;
}

std::uint32_t PadControls::buttons() const RELIEVO_RT {
  return (down_.has(button_keys_[0]) ? 1U : 0U) | (down_.has(button_keys_[1]) ? 2U : 0U);
}

}  // namespace relievo
