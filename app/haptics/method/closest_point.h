// SPDX-License-Identifier: Apache-2.0
// Sliding the proxy to the true closest point of a smooth surface, by Newton's method.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/haptics/method/felt_surface.h"
#include "platform/realtime.h"

namespace relievo {

// A place on the surface with what the surface is like there.
struct Contact {
  double x_mm = 0, y_mm = 0;
  SurfacePoint surface;
  bool settled = true;  // false: the search was cut short on its way, and the closest point lies further on
};

// A surface steeper than this is a wall: less than a sample's width is all of its height, and what slope and curvature
// say there holds for less than that.
inline constexpr double kWallSlope = 3;

// From (x, y) downhill to the local minimum of the distance between (x, y, S(x, y) - lowered) and the finger. Steps are
// short against the surface's features and must come closer, so that the way leads along the surface and not across it.
// At most 10 evaluations, `until` MuchRead none after the surface has read much in this tick: bounded time; what is
// left is made up in the next ticks, and `settled` says so.
enum class SlideUntil : std::uint8_t { Settled, MuchRead };
[[nodiscard]] Contact closestPoint(FeltSurface& surface, double x_mm, double y_mm, const glm::dvec3& hip_mm,
                                   double lowered_mm, SlideUntil until) RELIEVO_RT;

// Where the closest point goes when the finger moves by `moved_mm`, to first order; at most eight times as far.
[[nodiscard]] glm::dvec2 predictedStep(const Contact& contact, const glm::dvec3& hip_mm, const glm::dvec3& moved_mm,
                                       double lowered_mm) RELIEVO_RT;

}  // namespace relievo
