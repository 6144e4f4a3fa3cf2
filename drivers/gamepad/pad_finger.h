// SPDX-License-Identifier: Apache-2.0
// The finger that stick and trigger move. Pure arithmetic.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "platform/realtime.h"

namespace relievo {

// In the picture plane, the finger is at the stick's position along an axis with a motor. Along one without, it moves
// at the stick's speed, slower the stronger the force against it, and stops at 2 N, since a wall that only rumbles
// could otherwise be pushed through.
//
// In depth, a spring of 0.1 N/mm pulls the finger to the depth that the trigger sets: over a surface it arrives there,
// on a surface it presses with 0.1 N for each millimetre that the trigger is deeper, up to about 3 N. Its motion is
// damped and limited to 200 mm/s.
class PadFinger {
 public:
  static constexpr glm::dvec3 kMinMm{-100, -75, -20}, kMaxMm{100, 75, 60};
  // The ends of the workspace, which push back, are never reached.
  static constexpr glm::dvec3 kReachMinMm{-95, -70, -15}, kReachMaxMm{95, 70, 55};
  static constexpr glm::dvec3 kStartMm{0, 0, 55};

  // The first `motor_axes` of x and y have motors.
  explicit PadFinger(int motor_axes = 0) noexcept : motor_axes_(motor_axes) {}

  // Call once a tick: stick from -1 to 1 (x right, y up), trigger from 0 to 1, the force on the finger, the time since
  // the last call. Returns where the finger is, in the device's frame.
  [[nodiscard]] glm::dvec3 move(const glm::dvec2& stick, double pull, const glm::dvec3& force_n,
                                double elapsed_s) RELIEVO_RT;

 private:
  void steer(glm::dvec2 stick, const glm::dvec3& force_n, double elapsed_s) RELIEVO_RT;

  int motor_axes_;
  glm::dvec3 place_mm_ = kStartMm;
};

}  // namespace relievo
