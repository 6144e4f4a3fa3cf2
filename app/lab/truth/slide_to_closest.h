// SPDX-License-Identifier: Apache-2.0
// Descent on a smooth true surface to the place where the distance from a point is a local minimum.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/lab/truth/true_surface.h"

namespace relievo {

// Slides from above `from` downhill in distance, in short steps that never lengthen it, to the first place where it
// cannot fall any more. Stops when the next step is below `tolerance_mm` or is rounding alone (about 1e-13 mm). A
// saddle is no end: from there it goes on to one side.
[[nodiscard]] glm::dvec2 slideToClosest(const TrueSurface& surface, double t_s, const glm::dvec3& point_mm,
                                        const glm::dvec2& from_mm, double tolerance_mm);

}  // namespace relievo
