// SPDX-License-Identifier: Apache-2.0
// Estimates how far a silhouette edge near the finger moves from one frame to the next.
#pragma once

#include <glm/vec2.hpp>

#include "app/scene/height_field.h"
#include "platform/realtime.h"

namespace relievo {

// Between two frames a moving edge is at neither position: blending the frames would produce two half steps. This
// returns the displacement, in mm and perpendicular to the edge, that takes the edge near (x, y) from one frame to the
// other. Zero if there is no edge, if it stands still, or if no displacement explains the change.
//
// Reads 17 x 17 samples, 6 mm to either side. The volume that an edge sweeps is its height times its displacement,
// whatever its profile: displacement = - sum of the height change / |sum of the slope|, along the mean slope.
[[nodiscard]] glm::dvec2 edgeMotion(const HeightField& from, const HeightField& to, double x_mm,
                                    double y_mm) RELIEVO_RT;

}  // namespace relievo
