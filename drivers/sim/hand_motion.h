// SPDX-License-Identifier: Apache-2.0
// The built-in motions of a simulated hand: rest, press, stroke, tap, shake.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "platform/realtime.h"

namespace relievo {

// The hand's target.
struct HandPoint {
  glm::dvec3 position_mm{0};  // device frame
  // The most that the hand's spring pulls along each axis: a stroking hand yields to an obstacle instead of pressing
  // harder.
  double force_limit_n = std::numeric_limits<double>::infinity();
};

// Each begins at rest in front of the scene. The target is below the far plane, so that any surface stops the hand and
// it presses with its force limit wherever the surface is.
enum class HandMotion : std::uint8_t {
  Stroking,  // a Lissajous figure with a pressure that swells between 1 and 2 N; lifts every 4 s
  Resting,   // comes down once and rests on the surface with 1 N
  Pressing,  // the same with 4 N
  Tapping,   // once a second, at 0.3 m/s
  // Rests with 1.5 N and a tremor at 9 Hz: 0.5 mm in the air, half of its pressure on a surface. The strongest tremor
  // of 97 healthy people was 0.035 g at some 7 Hz (Arch. Neurol. 39:358, 1982), which is 0.2 mm; this one has 0.16 g.
  Shaking,
};

// `reach`: the fraction of the default workspace's width and height that the hand has; it scales the strokes.
[[nodiscard]] HandPoint moveHand(HandMotion motion, double t_s, double reach) RELIEVO_RT;

}  // namespace relievo
