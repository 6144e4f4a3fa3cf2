// SPDX-License-Identifier: Apache-2.0
// From a force to the kernel's effects: rumble, constant force, spring.
#pragma once

#include <linux/input.h>

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "drivers/gamepad/pad_port.h"
#include "platform/realtime.h"

namespace relievo {

// Levels in the kernel's units. All zero: silent.
struct RumbleLevel {
  std::uint16_t strong = 0, weak = 0;  // of 65535
  bool operator==(const RumbleLevel&) const = default;
};
struct ConstantLevel {
  std::int16_t level = 0;       // of 32767
  std::uint16_t direction = 0;  // 0 pushes toward the user, 0x4000 to the left, 0x8000 away, 0xC000 to the right
  bool operator==(const ConstantLevel&) const = default;
};
// A spring per axis, on one side of its centre; x to the right, y toward the user, as evdev counts.
struct SpringLevel {
  struct Axis {
    std::uint16_t above = 0, below = 0;  // coefficients, of 32767, where the stick is above or below the centre
    std::int16_t center = 0;
    bool operator==(const Axis&) const = default;
  };
  std::array<Axis, 2> axes{};
  bool operator==(const SpringLevel&) const = default;
};
struct PadLevels {
  RumbleLevel rumble;
  ConstantLevel constant;
  SpringLevel spring;
  bool operator==(const PadLevels&) const = default;
};

// The motors that a device has.
struct PadMotors {
  bool rumble = false, constant = false, spring = false;
  int axes = 0;  // that constant force and spring act on: 1 (a wheel) or 2; 0 without either
};

// The effect of a level, with the id -1. It ends by itself after kEffectMs, in case nobody stops it.
inline constexpr std::uint16_t kEffectMs = 1000;
[[nodiscard]] ff_effect effectOf(const RumbleLevel& level) noexcept;
[[nodiscard]] ff_effect effectOf(const ConstantLevel& level) noexcept;
[[nodiscard]] ff_effect effectOf(const SpringLevel& level) noexcept;

// The force as a fraction of the peak is split in two. Along the axes that have motors, a spring pushes with the whole
// fraction at the stick's present position, and keeps pushing by itself between two uploads: its centre lies ahead of
// the stick by the fraction, in units of half the stick's travel. It pushes on one side of the centre only, so that a
// surface does not stick. Constant force supplies what the spring cannot reach, or all of it without a spring.
//
// The rest, r, goes to the rumble. The strong motor shows how hard the contact is: |r|. The weak motor shows slope and
// texture: |r| times the sine of the slope's angle, plus the root mean square of the force's changes within about 50
// ms, in units of kRoughN. For the first 40 ms it also shows a contact, however soft.
class PadEffects {
 public:
  static constexpr double kPeakN = 4;
  static constexpr double kRoughN = 0.5;
  static constexpr double kContactN = 0.03;  // from here on it is felt
  static constexpr double kContactLevel = 0.6, kContactS = 0.04;

  PadEffects() = default;
  explicit PadEffects(const PadMotors& motors) noexcept : motors_(motors) {}

  // Call once a tick. `force_n`: on the hand, N, device frame. `stick`: from -1 to 1, x right, y up. Then the time
  // since the last call.
  [[nodiscard]] PadLevels follow(const glm::dvec3& force_n, const glm::dvec2& stick, double elapsed_s) RELIEVO_RT;
  // Whether the force of the last call is a contact.
  [[nodiscard]] bool contact() const RELIEVO_RT { return contact_; }

 private:
  [[nodiscard]] RumbleLevel rumble(const glm::dvec3& rest, double elapsed_s) RELIEVO_RT;

  PadMotors motors_;
  bool contact_ = false;
  double contact_s_ = 0;  // since it began
  glm::dvec3 slow_n_{0};  // the force without its fast changes
  double rough_n2_ = 0;   // mean square of these
};

}  // namespace relievo
