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
  double speed_mm_per_s = 100;  // speed of the touched point, seen from the front; 0: the finger stays where it came in
  double duration_s = 3;
  glm::dvec2 centre_mm{0};
  glm::dvec2 reach_mm{18, 15};  // of the Lissajous figure to each side; stays inside the exact part of the sphere

  static constexpr double kTickS = 0.001;
  static constexpr double kAboveMm = 10;     // height at which it begins
  static constexpr double kComingInS = 0.2;  // time from there to its depth, steadily and straight along the normal
};

// One entry per tick from time 0 on. Each is a point of the surface minus depth times its unit normal, both at the
// exact time of the tick. If no convex place of the surface is tighter than the depth, the proxy belongs at that point.
// Only for smooth surfaces: over the edge of a step and at a cut the finger would jump with the surface.
[[nodiscard]] std::vector<HipTick> makeFingerPath(const TrueSurface& surface, const FingerPathOptions& options);

}  // namespace relievo
