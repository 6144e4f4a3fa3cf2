// SPDX-License-Identifier: Apache-2.0
// Directions and levels are those of the kernel's Documentation/input/ff.rst and <linux/input.h>.
#include "drivers/gamepad/pad_effects.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace relievo {
namespace {

constexpr double kSlowS = 0.05;  // time constant of what counts as a change
constexpr double kFullLevel = 32767, kFullRumble = 65535;
constexpr std::uint16_t kFullSpring = 0x7fff, kSaturated = 0xffff;
constexpr std::uint16_t kToTheLeft = 0x4000;

std::uint16_t rumbleOf(double share) RELIEVO_RT {
  return static_cast<std::uint16_t>(std::lround(kFullRumble * std::clamp(share, 0.0, 1.0)));
}
std::int16_t levelOf(double share) RELIEVO_RT {
  return static_cast<std::int16_t>(std::lround(kFullLevel * std::clamp(share, -1.0, 1.0)));
}

// Makes the axis push with `share` at position `at`; returns the rest of the push, which it cannot produce because the
// centre cannot lie beyond the stick's end.
double lay(SpringLevel::Axis& spring, double at, double share) RELIEVO_RT {
  if (levelOf(share) == 0) return 0;
  const double center = std::clamp(at + share, -1.0, 1.0);
  spring.center = levelOf(center);
  (share > 0 ? spring.below : spring.above) = kFullSpring;
  return share - (center - at);
}

// Wheel drivers expect a fixed direction and a signed level; with two axes, the direction varies.
ConstantLevel constantOf(const glm::dvec2& share, int axes) RELIEVO_RT {
  const std::int16_t level = axes == 1 ? levelOf(-share.x) : levelOf(glm::length(share));
  if (level == 0) return {};
  if (axes == 1) return {.level = level, .direction = kToTheLeft};
  const double turns = std::atan2(-share.x, -share.y) / (2 * std::numbers::pi);
  return {.level = level, .direction = static_cast<std::uint16_t>(std::lround(65536 * turns))};
}

ff_effect lasting(std::uint16_t type) noexcept {
  ff_effect effect{};
  effect.type = type;
  effect.id = -1;
  effect.replay.length = kEffectMs;
  return effect;
}

}  // namespace

ff_effect effectOf(const RumbleLevel& level) noexcept {
  ff_effect effect = lasting(FF_RUMBLE);
  effect.u.rumble.strong_magnitude = level.strong;
  effect.u.rumble.weak_magnitude = level.weak;
  return effect;
}

ff_effect effectOf(const ConstantLevel& level) noexcept {
  ff_effect effect = lasting(FF_CONSTANT);
  effect.direction = level.direction;
  effect.u.constant.level = level.level;
  return effect;
}

ff_effect effectOf(const SpringLevel& level) noexcept {
  ff_effect effect = lasting(FF_SPRING);
  for (std::size_t i = 0; i < level.axes.size(); ++i) {
    ff_condition_effect& condition = effect.u.condition[i];
    condition.right_saturation = condition.left_saturation = kSaturated;
    condition.right_coeff = static_cast<std::int16_t>(level.axes[i].above);
    condition.left_coeff = static_cast<std::int16_t>(level.axes[i].below);
    condition.center = level.axes[i].center;
  }
  return effect;
}

PadLevels PadEffects::follow(const glm::dvec3& force_n, const glm::dvec2& stick, double elapsed_s) RELIEVO_RT {
  const bool contact = glm::length(force_n) >= kContactN;
  contact_s_ = contact && contact_ ? contact_s_ + elapsed_s : 0;
  contact_ = contact;
  PadLevels levels;
  if (!contact) {
    slow_n_ = glm::dvec3(0);
    rough_n2_ = 0;
    return levels;
  }
  glm::dvec3 rest = force_n / kPeakN;
  glm::dvec2 push(0);
  for (int axis = 0; axis < motors_.axes; ++axis) {
    push[axis] = rest[axis];
    rest[axis] = 0;
  }
  for (int axis = 0; motors_.spring && axis < motors_.axes; ++axis) {
    const double up = axis == 1 ? -1 : 1;  // evdev counts toward the user
    push[axis] = up * lay(levels.spring.axes[static_cast<std::size_t>(axis)], up * stick[axis], up * push[axis]);
  }
  if (motors_.constant) levels.constant = constantOf(push, motors_.axes);
  if (motors_.rumble) levels.rumble = rumble(rest, elapsed_s);
  return levels;
}

RumbleLevel PadEffects::rumble(const glm::dvec3& rest, double elapsed_s) RELIEVO_RT {
  const glm::dvec3 rest_n = kPeakN * rest;
  if (contact_s_ <= 0) slow_n_ = rest_n;
  const double step = 1 - std::exp(-elapsed_s / kSlowS);
  slow_n_ += step * (rest_n - slow_n_);
  const glm::dvec3 fast_n = rest_n - slow_n_;
  rough_n2_ += step * (glm::dot(fast_n, fast_n) - rough_n2_);
  const double slope = glm::length(glm::dvec2(rest));  // |r| times the sine
  double weak = slope + std::sqrt(rough_n2_) / kRoughN;
  if (contact_s_ < kContactS) weak = std::max(weak, kContactLevel);
  return {.strong = rumbleOf(glm::length(rest)), .weak = rumbleOf(weak)};
}

}  // namespace relievo
