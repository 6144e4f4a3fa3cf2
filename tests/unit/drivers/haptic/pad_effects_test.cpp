// SPDX-License-Identifier: Apache-2.0
// Levels of effects, compared with what a device does with them according to the kernel's documentation.
#include "drivers/gamepad/pad_effects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace relievo {
namespace {

constexpr double kTick = 0.001;
constexpr PadMotors kPad{.rumble = true};
constexpr PadMotors kWheel{.constant = true, .spring = true, .axes = 1};
constexpr PadMotors kJoystick{.rumble = true, .constant = true, .axes = 2};

// What a device pushes with, as fractions of its strength, to the right and away from the user. Constant force goes
// the way of its direction (<linux/input.h>: 0 is down, 0x4000 left, 0x8000 up, 0xC000 right). A spring pushes with
// coefficient times the way to its centre, evdev's y counting down.
glm::dvec2 pushOf(const PadLevels& levels, glm::dvec2 stick) {
  const double turn = 2 * std::numbers::pi * levels.constant.direction / 65536.0;
  const double level = levels.constant.level / 32767.0;
  glm::dvec2 push(-level * std::sin(turn), -level * std::cos(turn));
  stick.y = -stick.y;
  for (int axis = 0; axis < 2; ++axis) {
    const SpringLevel::Axis& spring = levels.spring.axes[static_cast<std::size_t>(axis)];
    const double way = spring.center / 32767.0 - stick[axis];
    const double coefficient = (way < 0 ? spring.above : spring.below) / 32767.0;
    push[axis] += (axis == 1 ? -1 : 1) * coefficient * way;
  }
  return push;
}

// After the contact has been reported.
PadLevels held(PadEffects& effects, const glm::dvec3& force_n, const glm::dvec2& stick = {}) {
  PadLevels levels;
  for (int i = 0; i < 1000; ++i) levels = effects.follow(force_n, stick, kTick);
  return levels;
}

TEST(PadEffects, TheStrongMotorTellsHowHardAndTheWeakOneTheSlope) {
  for (const double force_n : {0.1, 0.5, 1.0, 2.5, 4.0}) {
    for (const double tilt_deg : {0.0, 20.0, 45.0}) {
      SCOPED_TRACE(testing::Message() << force_n << " N, " << tilt_deg << " degrees");
      PadEffects effects(kPad);
      const double tilt = tilt_deg * std::numbers::pi / 180, turn = 2.5;
      const glm::dvec3 way(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
      const PadLevels levels = held(effects, force_n * way);
      EXPECT_NEAR(levels.rumble.strong, 65535 * force_n / 4, 0.02 * 65535 * force_n / 4);
      const double slope = 65535 * force_n / 4 * std::sin(tilt);
      EXPECT_NEAR(levels.rumble.weak, slope, 0.02 * slope + 1);
      EXPECT_EQ(levels.constant, ConstantLevel{});
      EXPECT_EQ(levels.spring, SpringLevel{});
    }
  }
}

TEST(PadEffects, AContactIsToldForFortyMillisecondsHoweverSoft) {
  PadEffects effects(kPad);
  EXPECT_EQ(effects.follow({0, 0, 0.02}, {}, kTick), PadLevels{}) << "nothing is felt yet";
  int told = 0;
  for (int i = 0; i < 200; ++i) told += effects.follow({0, 0, 0.05}, {}, kTick).rumble.weak > 0.59 * 65535 ? 1 : 0;
  EXPECT_NEAR(told, 40, 1);
  EXPECT_EQ(effects.follow({}, {}, kTick), PadLevels{}) << "no force, no rumble, whatever there was";
  EXPECT_NEAR(effects.follow({0, 0, 0.05}, {}, kTick).rumble.weak, 0.6 * 65535, 1) << "told anew";
}

// A sine of amplitude a at 50 Hz is a/sqrt(2) in the mean square; of it a high pass of 50 ms (3.2 Hz) passes 99.8 %.
TEST(PadEffects, TextureIsInTheWeakMotorAsStrongAsItIs) {
  PadEffects effects(kPad);
  for (const double amplitude_n : {0.1, 0.3}) {
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      const double wave = amplitude_n * std::sin(2 * std::numbers::pi * 50 * i * kTick);
      const PadLevels levels = effects.follow({0, 0, 2 + wave}, {}, kTick);
      if (i >= 1000) sum += levels.rumble.weak / 65535.0;
    }
    EXPECT_NEAR(sum / 1000, amplitude_n / std::numbers::sqrt2 / 0.5, 0.02 * amplitude_n / std::numbers::sqrt2 / 0.5);
  }
}

TEST(PadEffects, AJoystickPushesWithTheForceAlongItsAxesAndRumblesTheRest) {
  for (int degree = 0; degree < 360; degree += 15) {
    SCOPED_TRACE(degree);
    PadEffects effects(kJoystick);
    const double turn = degree * std::numbers::pi / 180;
    const PadLevels levels = held(effects, {1.2 * std::cos(turn), 1.2 * std::sin(turn), 1.6}, {0.3, -0.2});
    const glm::dvec2 expected = 0.3 * glm::dvec2(std::cos(turn), std::sin(turn));
    EXPECT_LT(glm::distance(pushOf(levels, {0.3, -0.2}), expected), 0.02 * 0.3);
    EXPECT_NEAR(levels.rumble.strong, 65535 * 0.4, 0.02 * 65535 * 0.4);
    EXPECT_LE(levels.rumble.weak, 1) << "the slope is in the stick";
  }
}

TEST(PadEffects, AWheelsSpringAndConstantForceAddUpToTheForceWhereverItStands) {
  for (const double place : {-1.0, -0.7, 0.0, 0.2, 0.9, 1.0}) {
    for (const double force_n : {-4.0, -1.0, -0.2, 0.2, 2.0, 4.0}) {
      SCOPED_TRACE(testing::Message() << force_n << " N at " << place);
      PadEffects effects(kWheel);
      const PadLevels levels = held(effects, {force_n, 0.5, 1}, {place, 0});
      EXPECT_NEAR(pushOf(levels, {place, 0}).x, force_n / 4, 0.02 * std::abs(force_n) / 4);
      EXPECT_EQ(levels.spring.axes[1], SpringLevel::Axis{}) << "a wheel has one axis";
      EXPECT_EQ(levels.rumble, RumbleLevel{}) << "and this one no rumble";
    }
  }
}

// Between two uploads the spring acts by itself: a finger that is a tenth of the range further in gets that much more
// force; beyond the spring's centre it is not pulled back.
TEST(PadEffects, TheSpringIsAWallThatDoesNotStick) {
  PadEffects effects(kWheel);
  const PadLevels right = held(effects, {1, 0, 0}, {0.1, 0});
  EXPECT_NEAR(pushOf(right, {0.0, 0}).x, 0.25 + 0.1, 0.001);
  EXPECT_NEAR(pushOf(right, {0.6, 0}).x, 0, 1e-9);
  const PadLevels left = held(effects, {-1, 0, 0}, {0.1, 0});
  EXPECT_NEAR(pushOf(left, {0.2, 0}).x, -0.25 - 0.1, 0.001);
  EXPECT_NEAR(pushOf(left, {-0.4, 0}).x, 0, 1e-9);
}

TEST(PadEffects, AnEffectIsTheKernelsAndEndsByItself) {
  const ff_effect rumble = effectOf(RumbleLevel{.strong = 1000, .weak = 2000});
  EXPECT_EQ(rumble.type, FF_RUMBLE);
  EXPECT_EQ(rumble.id, -1);
  EXPECT_EQ(rumble.replay.length, 1000);
  EXPECT_EQ(rumble.u.rumble.strong_magnitude, 1000);
  EXPECT_EQ(rumble.u.rumble.weak_magnitude, 2000);
  const ff_effect constant = effectOf(ConstantLevel{.level = -700, .direction = 0x4000});
  EXPECT_EQ(constant.type, FF_CONSTANT);
  EXPECT_EQ(constant.direction, 0x4000);
  EXPECT_EQ(constant.u.constant.level, -700);
  SpringLevel level;
  level.axes[0] = {.above = 3, .below = 4, .center = -5};
  const ff_effect spring = effectOf(level);
  EXPECT_EQ(spring.type, FF_SPRING);
  EXPECT_EQ(spring.u.condition[0].right_coeff, 3);
  EXPECT_EQ(spring.u.condition[0].left_coeff, 4);
  EXPECT_EQ(spring.u.condition[0].center, -5);
  EXPECT_EQ(spring.u.condition[0].right_saturation, 0xffff);
  EXPECT_EQ(spring.u.condition[1].left_coeff, 0);
}

}  // namespace
}  // namespace relievo
