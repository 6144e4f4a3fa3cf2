// SPDX-License-Identifier: Apache-2.0
// The complete driver of gamepads on a device that claims any properties, with any events and failures, and calls in
// any order: the finger is in the workspace, levels are within their limits, and effects play only while the driver
// runs.
#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "drivers/gamepad/gamepad.h"
#include "drivers/gamepad/pad_finger.h"
#include "tests/support/device/fake_pad.h"

namespace relievo {
namespace {

using State = HapticDevice::State;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

PadFacts anyFacts(FuzzedDataProvider& data) {
  PadFacts facts;
  facts.name = "pad";
  facts.effects_at_once = data.ConsumeIntegralInRange(0, 16);
  for (const unsigned code : {FF_RUMBLE, FF_CONSTANT, FF_SPRING, FF_GAIN, FF_AUTOCENTER}) {
    facts.forces.put(code, data.ConsumeBool());
  }
  for (const unsigned key : {BTN_SOUTH, BTN_EAST, BTN_TRIGGER, BTN_THUMB, BTN_TR2, BTN_WHEEL}) {
    facts.keys.put(key, data.ConsumeBool());
  }
  for (const unsigned code : {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ, ABS_GAS, ABS_HAT0Y}) {
    if (!data.ConsumeBool()) continue;
    facts.axes.put(code);
    facts.ranges[code].minimum = data.ConsumeIntegral<std::int32_t>();
    facts.ranges[code].maximum = data.ConsumeIntegral<std::int32_t>();
    facts.ranges[code].value = data.ConsumeIntegral<std::int32_t>();
  }
  return facts;
}

void check(const test::FakePad& pad) {
  if (const ff_effect* constant = pad.playing(FF_CONSTANT)) {
    require(std::abs(constant->u.constant.level) <= 32767, "a level is in its range");
  }
  if (const ff_effect* spring = pad.playing(FF_SPRING)) {
    for (const ff_condition_effect& axis : spring->u.condition) {
      require(axis.right_coeff >= 0 && axis.left_coeff >= 0, "a spring pulls to its centre");
      require(axis.right_coeff == 0 || axis.left_coeff == 0, "on one side");
    }
  }
}

void live(FuzzedDataProvider& data) {
  ManualClock clock;
  auto pad = std::make_shared<test::FakePad>();
  pad->facts = anyFacts(data);
  const auto device = makeGamepad(std::make_unique<test::FakePadPort>(pad), clock, {.effect_thread = false});
  while (data.remaining_bytes() > 0) {
    if (device->state() == State::Closed) (void)device->open();
    else if (device->state() == State::Opened) (void)device->home();
    else if (device->state() == State::Ready) (void)device->start();
    for (int i = data.ConsumeIntegralInRange(0, 40); i > 0 && device->state() == State::Running; --i) {
      clock.advance(std::chrono::microseconds(data.ConsumeIntegralInRange(0, 3000)));
      for (int events = data.ConsumeIntegralInRange(0, 3); events > 0; --events) {
        pad->say(data.ConsumeIntegralInRange<std::uint16_t>(0, EV_ABS), data.ConsumeIntegral<std::uint16_t>(),
                 data.ConsumeIntegral<std::int32_t>());
      }
      const auto sample = device->read();
      for (int axis = 0; sample && axis < 3; ++axis) {
        const double mm = sample->position_mm[axis];
        require(mm >= PadFinger::kMinMm[axis] && mm <= PadFinger::kMaxMm[axis], "the finger is in the workspace");
      }
      (void)device->write({data.ConsumeFloatingPointInRange(-3.0, 3.0), data.ConsumeFloatingPointInRange(-3.0, 3.0),
                           data.ConsumeFloatingPointInRange(-3.0, 3.0)});
      check(*pad);
    }
    const int verb = data.ConsumeIntegralInRange(0, 9);
    if (verb == 0) device->stop();
    if (verb == 1 || device->state() == State::Lost) device->close();
    if (verb == 2) pad->plugged = data.ConsumeBool();
    if (verb == 3) pad->refuses = data.ConsumeBool();
    require(!pad->pushes() || device->state() == State::Running, "nothing plays but while it runs");
    if (device->state() == State::Closed) pad->plugged = true;
  }
  device->close();
  require(!pad->hasEffects(), "closed has no effects");
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  relievo::live(data);
  return 0;
}
