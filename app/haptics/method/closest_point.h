// SPDX-License-Identifier: Apache-2.0
// Moves the proxy to the local closest point of a smooth surface by Newton's method.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/haptics/method/felt_surface.h"
#include "platform/realtime.h"

namespace relievo {

// A point on the surface and the surface's properties there.
struct Contact {
  double x_mm = 0, y_mm = 0;
  SurfacePoint surface;
  bool settled = true;  // false: the search was cut short, and the closest point lies further on
};

// A surface steeper than this is a wall: its whole height lies within a sample's width, and its slope and curvature
// hold for even less than that.
inline constexpr double kWallSlope = 3;

// Descends from (x, y) to the local minimum of the distance between (x, y, S(x, y) - lowered) and the finger. Steps are
// short against the surface's features and must reduce the distance, so that the path follows the surface. At most 10
// evaluations, so the time is bounded; with `MuchRead` the search stops once this tick's read budget is spent. The next
// ticks continue it, and `settled` is false meanwhile.
enum class SlideUntil : std::uint8_t { Settled, MuchRead };
[[nodiscard]] Contact closestPoint(FeltSurface& surface, double x_mm, double y_mm, const glm::dvec3& hip_mm,
                                   double lowered_mm, SlideUntil until) RELIEVO_RT;

// First-order prediction of the closest point's motion when the finger moves by `moved_mm`; at most eight times as far.
[[nodiscard]] glm::dvec2 predictedStep(const Contact& contact, const glm::dvec3& hip_mm, const glm::dvec3& moved_mm,
                                       double lowered_mm) RELIEVO_RT;

}  // namespace relievo
