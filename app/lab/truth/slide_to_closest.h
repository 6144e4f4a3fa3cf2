// SPDX-License-Identifier: Apache-2.0
// Descent on a smooth true surface to a local minimum of the distance from a point.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/lab/truth/true_surface.h"

namespace relievo {

// Starts above `from` and moves in short steps that never lengthen the distance, to the first place where it cannot
// fall any more. Stops when the next step is below `tolerance_mm` or only rounding (about 1e-13 mm). From a saddle it
// continues to one side.
[[nodiscard]] glm::dvec2 slideToClosest(const TrueSurface& surface, double t_s, const glm::dvec3& point_mm,
                                        const glm::dvec2& from_mm, double tolerance_mm);

}  // namespace relievo
