// SPDX-License-Identifier: Apache-2.0
// Paths of a finger over a true surface, for measurements.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "app/lab/finger/hip_path.h"
#include "app/lab/truth/true_surface.h"

namespace relievo {

struct FingerPathOptions {
  double depth_mm = 5;          // below the surface, along its normal
  double speed_mm_per_s = 100;  // of the place on the surface, seen from the front; 0: held where it has come in
  double duration_s = 3;
  glm::dvec2 centre_mm{0};
  glm::dvec2 reach_mm{18, 15};  // of the Lissajous figure to each side: inside the exact part of the sphere

  static constexpr double kTickS = 0.001;
  static constexpr double kAboveMm = 10;     // where it begins
  static constexpr double kComingInS = 0.2;  // from there to its depth, steadily and straight along the normal
};

// One entry per tick from time 0 on. Each is a place on the surface less depth times its unit normal, both at the exact
// time of the tick: on a surface without a convex place tighter than the depth that place is where the proxy belongs.
// For smooth surfaces: over the edge of a step and at a cut the finger would jump with the surface.
[[nodiscard]] std::vector<HipTick> makeFingerPath(const TrueSurface& surface, const FingerPathOptions& options);

}  // namespace relievo
