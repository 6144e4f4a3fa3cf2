// SPDX-License-Identifier: Apache-2.0
// The errors that smoothing causes at an edge of the relief.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Writes edges.csv, a row for each kind of depth, speed of the edge, and method or width. The scenes are step and
// step-moving: a floor 15 mm above another one, separated by an upright wall slanted to the samples, which is still or
// moves along x towards the low floor (+) or the high one (-).
//
// - `corner`: how far from the edge the surface is met by a finger that comes down on the edge from outside, half way
//   between floor and wall, at 20 mm/s; the mean over the places, and the worst.
// - `fall_off`: how far beyond the edge a finger that is swept off the high floor at 100 mm/s, 2 and 5 mm deep, has
//   lost half of its force; negative before the edge. Root mean square, earliest and latest.
//   `worst`: the larger of these two.
// - `held`: places at which half of the force was still there 8 mm beyond the edge; they count as 8 mm.
// The finger's speeds are relative to the edge. A quick run uses fewer places.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureEdges(const MeasureOptions& options);

}  // namespace relievo
