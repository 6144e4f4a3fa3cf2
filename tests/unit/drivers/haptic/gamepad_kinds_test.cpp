// SPDX-License-Identifier: Apache-2.0
// The gamepads, joysticks and wheels that people own: what each one's axes and keys are, before its first report and
// after it, and what is played on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "drivers/gamepad/gamepad.h"
#include "drivers/gamepad/pad_controls.h"
#include "tests/support/device/fake_pad.h"
#include "tests/support/device/real_pads.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::RealPad;

input_event turned(unsigned axis, int value) {
  return {.time = {}, .type = EV_ABS, .code = static_cast<std::uint16_t>(axis), .value = value};
}

// Worn sticks rest up to 12 % off their middle.
void expectAtRest(const PadControls& controls) {
  EXPECT_EQ(controls.pull(), 0);
  EXPECT_LT(glm::length(controls.stick()), 0.12);
  EXPECT_EQ(controls.buttons(), 0U);
}

TEST(RealPads, AtRestNothingIsPressedAndTheStickIsInTheMiddle) {
  for (const RealPad& pad : test::realPads()) {
    SCOPED_TRACE(pad.name);
    EXPECT_TRUE(isPad(pad.silent()));
    expectAtRest(PadControls(pad.atRest()));
    PadControls controls(pad.silent());
    EXPECT_EQ(controls.isWheel(), pad.motor_axes == 1);
    for (const RealPad::Axis& axis : pad.axes) controls.setAxis(axis.code, 0);  // as the kernel answers when asked
    expectAtRest(controls);
    for (const RealPad::Axis& axis : pad.axes) {
      controls.take(turned(axis.code, axis.rest));
      expectAtRest(controls);
    }
  }
}

// Only these: the second stick turned to its ends, a twist or a throttle do not press.
TEST(RealPads, TheirTriggersPedalsOrKeyPress) {
  for (const RealPad& pad : test::realPads()) {
    SCOPED_TRACE(pad.name);
    PadControls controls(pad.atRest());
    for (const RealPad::Axis& axis : pad.axes) {
      SCOPED_TRACE(axis.code);
      const auto press = std::ranges::find(pad.presses, axis.code, &std::pair<unsigned, int>::first);
      for (const int end : {axis.low, axis.high}) {
        controls.take(turned(axis.code, end));
        const bool pressed = press != pad.presses.end() && press->second == end;
        EXPECT_EQ(controls.pull(), pressed ? 1 : 0) << end;
      }
      controls.take(turned(axis.code, axis.rest));
    }
    InputKeys down;
    down.put(pad.press_key);
    controls.setKeys(down);
    EXPECT_EQ(controls.pull() > 0, pad.press_key != KEY_CNT);
  }
}

TEST(RealPads, EachPlaysWithWhatItHas) {
  for (const RealPad& pad : test::realPads()) {
    SCOPED_TRACE(pad.name);
    ManualClock clock{MonotonicTime(1h)};
    const auto fake = std::make_shared<test::FakePad>();
    fake->facts = pad.silent();
    const auto device = makeGamepad(std::make_unique<test::FakePadPort>(fake), clock, {.effect_thread = false});
    ASSERT_TRUE(device->open() && device->home() && device->start());
    HapticSample sample;
    for (int i = 0; i < 500; ++i) {
      clock.advance(1ms);
      sample = device->read().value();
      ASSERT_TRUE(device->write({1, 0.5, 2}));
    }
    EXPECT_EQ(sample.position_mm, glm::dvec3(0, 0, 55)) << "it has reported nothing yet";
    const ff_effect *rumble = fake->playing(FF_RUMBLE), *constant = fake->playing(FF_CONSTANT);
    const ff_effect* spring = fake->playing(FF_SPRING);
    EXPECT_EQ(rumble != nullptr, fake->facts.forces.has(FF_RUMBLE));
    EXPECT_EQ(constant != nullptr || spring != nullptr, pad.motor_axes > 0);
    if (rumble != nullptr) {
      const glm::dvec3 rest_n(pad.motor_axes > 0 ? 0 : 1, pad.motor_axes > 1 ? 0 : 0.5, 2);
      EXPECT_NEAR(rumble->u.rumble.strong_magnitude, 65535 * glm::length(rest_n) / 4, 700);
    }
  }
}

TEST(Pads, AGamepadWithoutForceFeedbackIsToldFromWhatIsNone) {
  PadFacts silent = test::xboxPad();
  EXPECT_FALSE(isPadWithoutForce(silent));
  silent.effects_at_once = 0;
  EXPECT_TRUE(isPadWithoutForce(silent));
  PadFacts plain = test::wheel();
  plain.forces = {};
  EXPECT_TRUE(isPadWithoutForce(plain));
  PadFacts screen = test::padFacts({}, {BTN_TOUCH});
  test::addAxis(screen, ABS_X, 0, 4095, 0);
  EXPECT_FALSE(isPadWithoutForce(screen));
  PadFacts keyboard = test::padFacts({}, {BTN_TRIGGER, KEY_A});  // some claim to be a joystick of one axis
  test::addAxis(keyboard, ABS_X, 0, 255, 0);
  EXPECT_FALSE(isPadWithoutForce(keyboard));
  EXPECT_FALSE(isPadWithoutForce(test::padFacts({}, {BTN_TRIGGER}))) << "a throttle without a stick";
}

}  // namespace
}  // namespace relievo
