// SPDX-License-Identifier: Apache-2.0
// How a silhouette moves from one frame to the next, near the finger.
#pragma once

#include <glm/vec2.hpp>

#include "app/scene/height_field.h"
#include "platform/realtime.h"

namespace relievo {

// Between two frames a moving edge is at neither place: blending the frames would make two half steps of it. This is
// the displacement, mm, that takes the edge near (x, y) from one frame to the other, across itself; zero where there is
// no edge, where it stands still, and where a displacement does not explain what changes.
//
// Looks at 17 x 17 samples, 6 mm to either side. The volume that an edge sweeps is its height times its way, whatever
// its profile: displacement = - sum of the change in height / |sum of the slope|, along the mean slope.
[[nodiscard]] glm::dvec2 edgeMotion(const HeightField& from, const HeightField& to, double x_mm,
                                    double y_mm) RELIEVO_RT;

}  // namespace relievo
