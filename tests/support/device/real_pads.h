// SPDX-License-Identifier: Apache-2.0
// Gamepads, joysticks and wheels that people own, as their kernel drivers describe them: axes with ranges and places at
// rest, buttons, kinds of force. After the drivers' sources and users' listings (evtest); the two joysticks are made up
// after what hid-pidff does with their kind.
#pragma once

#include <linux/input.h>

#include <utility>
#include <vector>

#include "drivers/gamepad/pad_port.h"

namespace relievo::test {

struct RealPad {
  struct Axis {
    unsigned code;
    int low, high, rest;
  };
  const char* name;
  std::vector<unsigned> forces, keys;
  std::vector<Axis> axes;
  int motor_axes = 0;                             // of a stick or a wheel that pushes
  std::vector<std::pair<unsigned, int>> presses;  // trigger or pedal, and its position when it is pressed all the way
  unsigned press_key = KEY_CNT;

  // Before its first report: the kernel then has 0 for every axis.
  [[nodiscard]] PadFacts silent() const {
    PadFacts facts;
    facts.name = name;
    facts.effects_at_once = 16;  // of ff-memless; hid-pidff has more
    for (const unsigned force : forces) facts.forces.put(force);
    for (const unsigned key : keys) facts.keys.put(key);
    for (const Axis& axis : axes) {
      facts.axes.put(axis.code);
      facts.ranges[axis.code] = {.minimum = axis.low, .maximum = axis.high};
    }
    return facts;
  }
  [[nodiscard]] PadFacts atRest() const {
    PadFacts facts = silent();
    for (const Axis& axis : axes) facts.ranges[axis.code].value = axis.rest;
    return facts;
  }
};

inline std::vector<RealPad> realPads() {
  using Axes = std::vector<RealPad::Axis>;
  using Codes = std::vector<unsigned>;
  const Codes rumble{FF_RUMBLE, FF_PERIODIC, FF_SINE, FF_SQUARE, FF_TRIANGLE, FF_GAIN};
  const Codes pid{FF_RUMBLE, FF_PERIODIC, FF_CONSTANT, FF_SPRING, FF_DAMPER, FF_FRICTION, FF_INERTIA, FF_RAMP, FF_GAIN};
  const Codes buttons{BTN_SOUTH,  BTN_EAST,  BTN_NORTH, BTN_WEST,   BTN_TL,    BTN_TR,
                      BTN_SELECT, BTN_START, BTN_MODE,  BTN_THUMBL, BTN_THUMBR};
  const Codes more{BTN_SOUTH, BTN_EAST,   BTN_NORTH, BTN_WEST, BTN_TL,     BTN_TR,    BTN_TL2,
                   BTN_TR2,   BTN_SELECT, BTN_START, BTN_MODE, BTN_THUMBL, BTN_THUMBR};
  const Codes numbered{BTN_TRIGGER, BTN_THUMB, BTN_THUMB2, BTN_TOP, BTN_TOP2, BTN_PINKIE};
  const auto with = [](Axes axes, const Axes& others) {
    axes.insert(axes.end(), others.begin(), others.end());
    return axes;
  };
  const Axes hat{{ABS_HAT0X, -1, 1, 0}, {ABS_HAT0Y, -1, 1, 0}};
  const auto sticks = [&](unsigned x, unsigned y, int low, int high, int rest) {
    return with(hat, {{ABS_X, low, high, rest}, {ABS_Y, low, high, rest}, {x, low, high, rest}, {y, low, high, rest}});
  };
  const Axes wide = sticks(ABS_RX, ABS_RY, -32768, 32767, 300), bytes = sticks(ABS_RX, ABS_RY, 0, 255, 127);
  const auto zAndRz = [](int most) { return Axes{{ABS_Z, 0, most, 0}, {ABS_RZ, 0, most, 0}}; };
  const auto gasAndBrake = [](int most) { return Axes{{ABS_GAS, 0, most, 0}, {ABS_BRAKE, 0, most, 0}}; };
  const Axes touchpads{{ABS_HAT0X, -32767, 32767, 0}, {ABS_HAT0Y, -32767, 32767, 0}, {ABS_HAT1X, -32767, 32767, 0},
                       {ABS_HAT1Y, -32767, 32767, 0}, {ABS_HAT2X, 0, 32767, 0},      {ABS_HAT2Y, 0, 32767, 0}};
  const Axes deck{
      {ABS_X, -32767, 32767, 0}, {ABS_Y, -32767, 32767, 0}, {ABS_RX, -32767, 32767, 0}, {ABS_RY, -32767, 32767, 0}};
  const Axes fanatec{{ABS_X, 0, 65535, 32782},    {ABS_Y, 0, 65535, 65535},  {ABS_Z, 0, 65535, 65535},
                     {ABS_RX, 0, 65535, 0},       {ABS_RY, 0, 65535, 0},     {ABS_RZ, 0, 65535, 65535},
                     {ABS_THROTTLE, 0, 255, 255}, {ABS_RUDDER, -128, 127, 0}};
  return {
      {"Microsoft X-Box One pad", rumble, buttons, with(wide, zAndRz(1023)), 0, {{ABS_Z, 1023}, {ABS_RZ, 1023}}},
      {"Xbox Wireless Controller",
       rumble,
       buttons,
       with(sticks(ABS_Z, ABS_RZ, 0, 65535, 33000), gasAndBrake(1023)),
       0,
       {{ABS_GAS, 1023}, {ABS_BRAKE, 1023}}},
      {"Wireless Controller", rumble, more, with(bytes, zAndRz(255)), 0, {{ABS_Z, 255}, {ABS_RZ, 255}}},  // DualShock 4
      {"DualSense Wireless Controller", rumble, more, with(bytes, zAndRz(255)), 0, {{ABS_Z, 255}, {ABS_RZ, 255}}},
      {"Pro Controller", rumble, more, sticks(ABS_RX, ABS_RY, -32767, 32767, -900), 0, {}, BTN_TR2},  // Nintendo
      {"8BitDo Ultimate Controller", rumble, buttons, with(wide, zAndRz(255)), 0, {{ABS_Z, 255}, {ABS_RZ, 255}}},
      {"Google LLC Stadia Controller rev. A",
       rumble,
       more,
       with(sticks(ABS_Z, ABS_RZ, 1, 255, 128), gasAndBrake(255)),
       0,
       {{ABS_GAS, 255}, {ABS_BRAKE, 255}}},
      {"Steam Deck", rumble, more, with(deck, touchpads), 0, {{ABS_HAT2X, 32767}, {ABS_HAT2Y, 32767}}},
      {"Logitech Gamepad F710", rumble, buttons, with(wide, zAndRz(255)), 0, {{ABS_Z, 255}, {ABS_RZ, 255}}},
      {"Logitech Logitech Cordless RumblePad 2",
       rumble,
       numbered,
       sticks(ABS_Z, ABS_RZ, 0, 255, 128),
       0,
       {},
       BTN_TRIGGER},  // F710 in mode D
      {"Logitech G29 Driving Force Racing Wheel",
       {FF_CONSTANT, FF_GAIN, FF_AUTOCENTER},
       numbered,
       with(hat, {{ABS_X, 0, 65535, 32839}, {ABS_Y, 0, 255, 255}, {ABS_Z, 0, 255, 255}, {ABS_RZ, 0, 255, 255}}),
       1,
       {{ABS_Y, 0}, {ABS_Z, 0}, {ABS_RZ, 0}}},
      {"Thrustmaster Thrustmaster T300RS Racing wheel",
       pid,
       numbered,
       with(hat,
            {{ABS_X, 0, 65535, 32768}, {ABS_Y, 0, 1023, 1023}, {ABS_RZ, 0, 1023, 1023}, {ABS_THROTTLE, 0, 1023, 1023}}),
       1,
       {{ABS_Y, 0}, {ABS_RZ, 0}}},
      {"Fanatec FANATEC Wheel",
       {FF_CONSTANT, FF_SPRING, FF_DAMPER, FF_GAIN},
       numbered,
       with(hat, fanatec),
       1,
       {{ABS_Y, 0}, {ABS_Z, 0}, {ABS_RZ, 0}}},
      {"Smarty Co. VRS DirectForce Pro Wheel Base",
       pid,
       {},
       {{ABS_X, -32767, 32767, -487}, {ABS_Y, 0, 255, 0}},
       1,
       {{ABS_Y, 255}}},
      {"a joystick with a twist",
       pid,
       numbered,
       with(hat, {{ABS_X, -512, 511, 3}, {ABS_Y, -512, 511, -4}, {ABS_RZ, -32, 31, 0}, {ABS_THROTTLE, 0, 127, 64}}),
       2,
       {},
       BTN_TRIGGER},
      {"a joystick base with six axes",
       pid,
       numbered,
       with(sticks(ABS_RX, ABS_RY, -32768, 32767, 9), {{ABS_Z, -32768, 32767, 9}, {ABS_RZ, -32768, 32767, 9}}),
       2,
       {},
       BTN_TRIGGER},
  };
}

}  // namespace relievo::test
