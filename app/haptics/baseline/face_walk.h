// SPDX-License-Identifier: Apache-2.0
// Walking the proxy over the triangles of the relief to where it is closest to the finger: a converged god-object.
#pragma once

#include <glm/vec3.hpp>

#include "app/haptics/baseline/segment_search.h"
#include "app/haptics/baseline/surface_in_time.h"
#include "platform/realtime.h"

namespace relievo {

// From the triangle that the finger went through to the local minimum of the distance to `hip_mm` on the triangulated
// surface (Zilles and Salisbury 1995, with the constraint planes found by walking from triangle to neighbour instead of
// one at a time): inside a face the walk ends, from an edge it looks at the face beyond, from a vertex at the six faces
// around it. At most 256 steps in a tick.
[[nodiscard]] glm::dvec3 walkFacesToClosest(const SurfaceInTime& surface, const Crossing& crossing,
                                            const glm::dvec3& hip_mm) RELIEVO_RT;

}  // namespace relievo
