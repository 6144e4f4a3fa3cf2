// SPDX-License-Identifier: Apache-2.0
// Contact search on the triangulated relief: finds where a segment first passes from above the surface to below it.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "app/haptics/baseline/surface_in_time.h"
#include "platform/realtime.h"

namespace relievo {

struct Crossing {
  glm::dvec3 point_mm{0};
  GridTriangle triangle;
};

// The segment is projected on the grid and followed from triangle to triangle (paper, III; Walker and Salisbury 2003):
// no tree is needed, and only triangles on its way are tested. For a segment that begins below the surface, comes up
// and goes down again, the point where it goes down is found. Entering from the side, through the rim of a hole or of
// the grid, is no crossing.
[[nodiscard]] std::optional<Crossing> firstCrossing(const SurfaceInTime& surface, const glm::dvec3& from_mm,
                                                    const glm::dvec3& to_mm) RELIEVO_RT;

}  // namespace relievo
