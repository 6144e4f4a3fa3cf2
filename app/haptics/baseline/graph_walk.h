// SPDX-License-Identifier: Apache-2.0
// Moves the proxy over the edges and vertices of the triangulated relief to the point closest to the finger.
#pragma once

#include <glm/vec3.hpp>

#include "app/haptics/baseline/segment_search.h"
#include "app/haptics/baseline/surface_in_time.h"
#include "platform/realtime.h"

namespace relievo {

// Starts at the triangle that the finger went through and ends at the local minimum of the distance to `hip_mm` among
// the points on edges (Walker and Salisbury 2003: the proxy is restricted to edges and vertices). From a point on an
// edge the walk may go to any edge of the two adjacent triangles, from a vertex to any edge of the triangles around it;
// it goes to the closest one while that reduces the distance. At most kMaxSteps steps in a tick; the next tick
// continues.
[[nodiscard]] glm::dvec3 walkToClosest(const SurfaceInTime& surface, const Crossing& crossing,
                                       const glm::dvec3& hip_mm) RELIEVO_RT;

}  // namespace relievo
