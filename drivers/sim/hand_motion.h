// SPDX-License-Identifier: Apache-2.0
// What a simulated hand does of its own: rest, press, stroke, tap, shake.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "platform/realtime.h"

namespace relievo {

// Where the hand wants to be.
struct HandPoint {
  glm::dvec3 position_mm{0};  // device frame
  // How hard the hand's spring pulls along each axis at most: a hand that strokes gives way sooner than it
  // lags.
  double force_limit_n = std::numeric_limits<double>::infinity();
};

// Each begins at rest in front of the scene. It aims below the far plane, so that any surface stops it: what it
// presses with is its limit, wherever the surface is.
enum class HandMotion : std::uint8_t {
  Stroking,  // a Lissajous figure with a pressure that swells between 1 and 2 N; lifts every 4 s
  Resting,   // comes down once and rests on the surface with 1 N
  Pressing,  // the same with 4 N
  Tapping,   // once a second, at 0.3 m/s
  // Rests with 1.5 N and a tremor at 9 Hz: 0.5 mm in the air, half of its pressure on the surface. Of 97 healthy
  // people the strongest had 0.035 g at some 7 Hz (Arch. Neurol. 39:358, 1982), which is 0.2 mm; this one has 0.16 g.
  Shaking,
};

// `reach`: how much of the default workspace's width and height the hand has; its strokes are smaller by it.
[[nodiscard]] HandPoint moveHand(HandMotion motion, double t_s, double reach) RELIEVO_RT;

}  // namespace relievo
