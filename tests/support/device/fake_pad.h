// SPDX-License-Identifier: Apache-2.0
// A gamepad, a joystick or a wheel whose events come from the test, and which shows what it plays.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <initializer_list>
#include <memory>
#include <optional>

#include "drivers/gamepad/pad_port.h"

namespace relievo::test {

inline PadFacts padFacts(std::initializer_list<unsigned> forces, std::initializer_list<unsigned> keys) {
  PadFacts facts;
  facts.name = "pad";
  facts.effects_at_once = 16;
  for (const unsigned force : forces) facts.forces.put(force);
  for (const unsigned key : keys) facts.keys.put(key);
  return facts;
}
inline void addAxis(PadFacts& facts, unsigned code, int low, int high, int value) {
  facts.axes.put(code);
  facts.ranges[code] = {.value = value, .minimum = low, .maximum = high, .fuzz = 0, .flat = 0, .resolution = 0};
}

// An Xbox 360 pad, as the kernel's driver xpad describes it.
inline PadFacts xboxPad() {
  PadFacts facts = padFacts({FF_RUMBLE, FF_PERIODIC, FF_SINE, FF_GAIN}, {BTN_SOUTH, BTN_EAST, BTN_TL, BTN_TR});
  for (const unsigned code : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) addAxis(facts, code, -32768, 32767, 0);
  for (const unsigned code : {ABS_Z, ABS_RZ}) addAxis(facts, code, 0, 255, 0);
  for (const unsigned code : {ABS_HAT0X, ABS_HAT0Y}) addAxis(facts, code, -1, 1, 0);
  return facts;
}
// A Logitech G29, as hid-lg4ff describes it, with pedals at their upper ends.
inline PadFacts wheel() {
  PadFacts facts = padFacts({FF_CONSTANT, FF_SPRING, FF_GAIN, FF_AUTOCENTER}, {BTN_TRIGGER, BTN_THUMB, BTN_THUMB2});
  addAxis(facts, ABS_X, 0, 65535, 32768);
  for (const unsigned code : {ABS_Y, ABS_Z, ABS_RZ}) addAxis(facts, code, 0, 255, 255);
  for (const unsigned code : {ABS_HAT0X, ABS_HAT0Y}) addAxis(facts, code, -1, 1, 0);
  return facts;
}
inline PadFacts joystick() {
  PadFacts facts = padFacts({FF_CONSTANT, FF_RUMBLE, FF_GAIN, FF_AUTOCENTER}, {BTN_TRIGGER, BTN_THUMB, BTN_THUMB2});
  for (const unsigned code : {ABS_X, ABS_Y}) addAxis(facts, code, 0, 1023, 512);
  addAxis(facts, ABS_RZ, 0, 255, 128);  // it twists
  addAxis(facts, ABS_THROTTLE, 0, 255, 60);
  return facts;
}

struct FakePad {
  PadFacts facts = xboxPad();
  std::deque<input_event> events;
  InputKeys down;  // as the kernel knows it, besides the axes' values in `facts`
  bool plugged = true;
  bool comes_back = false;         // it is plugged in again before the next `open`
  bool goes_when_started = false;  // is unplugged after its keys were read
  bool refuses = false;            // takes no effect
  int uploads = 0;

  struct Effect {
    bool made = false, playing = false;
    ff_effect last{};
    int plays = 0;
  };
  std::array<Effect, 16> effects{};
  int gain = -1, centring = -1;  // as sent last

  [[nodiscard]] const ff_effect* playing(std::uint16_t type) const {
    for (const Effect& each : effects) {
      if (each.made && each.playing && each.last.type == type) return &each.last;
    }
    return nullptr;
  }
  [[nodiscard]] bool pushes() const {
    return plugged && std::ranges::any_of(effects, [](const Effect& each) { return each.made && each.playing; });
  }
  [[nodiscard]] bool hasEffects() const { return std::ranges::any_of(effects, &Effect::made); }

  void say(std::uint16_t type, std::uint16_t code, std::int32_t value) {
    events.push_back({.time = {}, .type = type, .code = code, .value = value});
  }
  void turn(std::uint16_t code, std::int32_t value) {
    facts.ranges[code].value = value;
    say(EV_ABS, code, value);
    say(EV_SYN, SYN_REPORT, 0);
  }
  void press(std::uint16_t key, bool on) {
    down.put(key, on);
    say(EV_KEY, key, on ? 1 : 0);
    say(EV_SYN, SYN_REPORT, 0);
  }
};

class FakePadPort final : public PadPort {
 public:
  explicit FakePadPort(std::shared_ptr<FakePad> pad) : pad_(std::move(pad)) {}

  Result<PadFacts> open() override {
    if (pad_->comes_back) pad_->plugged = true;
    if (!pad_->plugged) return fail(ErrorCode::NotFound, "no pad is plugged in");
    return pad_->facts;
  }
  void close() noexcept override { pad_->effects = {}; }

  Result<std::size_t> take(std::span<input_event> events) RELIEVO_RT override {
    if (!pad_->plugged) return gone();
    const std::size_t count = std::min(events.size(), pad_->events.size());
    std::copy_n(pad_->events.begin(), count, events.begin());
    pad_->events.erase(pad_->events.begin(), pad_->events.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  Result<InputKeys> keysDown() RELIEVO_RT override {
    if (!pad_->plugged) return gone();
    return pad_->down;
  }
  Result<std::int32_t> axis(unsigned code) RELIEVO_RT override {
    if (!pad_->plugged) return gone();
    return pad_->facts.ranges[code].value;
  }

  Result<std::int16_t> upload(const ff_effect& effect) noexcept override {
    if (!pad_->plugged) return gone();
    if (pad_->refuses) return fail(ErrorCode::Io, "it takes no effect");
    const auto free = std::ranges::find(pad_->effects, false, &FakePad::Effect::made) - pad_->effects.begin();
    const auto id = static_cast<std::size_t>(effect.id < 0 ? free : effect.id);
    if (id >= pad_->effects.size()) return fail(ErrorCode::Exhausted, "it has no room for another effect");
    pad_->effects[id].made = true;
    pad_->effects[id].last = effect;
    pad_->effects[id].last.id = static_cast<std::int16_t>(id);
    ++pad_->uploads;
    if (pad_->goes_when_started) pad_->plugged = false;
    return static_cast<std::int16_t>(id);
  }
  Result<void> erase(std::int16_t id) noexcept override {
    if (!pad_->plugged) return gone();
    pad_->effects.at(static_cast<std::size_t>(id)) = {};
    return {};
  }
  Result<void> send(std::uint16_t code, std::int32_t value) noexcept override {
    if (!pad_->plugged) return gone();
    if (code == FF_GAIN) pad_->gain = value;
    if (code == FF_AUTOCENTER) pad_->centring = value;
    if (code >= pad_->effects.size()) return {};
    pad_->effects[code].playing = value != 0;
    if (value != 0) ++pad_->effects[code].plays;
    return {};
  }

 private:
  static std::unexpected<Error> gone() RELIEVO_RT { return fail(ErrorCode::Lost, "the pad was unplugged"); }
  std::shared_ptr<FakePad> pad_;
};

}  // namespace relievo::test
