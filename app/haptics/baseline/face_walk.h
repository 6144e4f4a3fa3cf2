// SPDX-License-Identifier: Apache-2.0
// Moves the proxy over the relief's triangles to the point closest to the finger: a converged god-object.
#pragma once

#include <glm/vec3.hpp>

#include "app/haptics/baseline/segment_search.h"
#include "app/haptics/baseline/surface_in_time.h"
#include "platform/realtime.h"

namespace relievo {

// Starts at the triangle that the finger went through and ends at the local minimum of the distance to `hip_mm` on the
// triangulated surface (Zilles and Salisbury 1995; the constraint planes are found by walking from a triangle to its
// neighbours instead of one at a time). Inside a face the walk ends; at an edge it tries the face beyond, at a vertex
// the six faces around it. At most 256 steps in a tick.
[[nodiscard]] glm::dvec3 walkFacesToClosest(const SurfaceInTime& surface, const Crossing& crossing,
                                            const glm::dvec3& hip_mm) RELIEVO_RT;

}  // namespace relievo
