// SPDX-License-Identifier: Apache-2.0
// What smoothing costs where the relief has an edge.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Leaves edges.csv, a row for each kind of depth, speed of the edge and method or width. The scenes are step and
// step-moving: a floor 15 mm above another one, parted by an upright wall slanted to the samples, still or going
// along x towards the low floor (+) or the high one (-).
//
// - `corner`: how far from the edge a finger that comes down on it from outside, half way between floor and wall, at
//   20 mm/s finds the surface; the mean over the places, and at worst.
// - `fall_off`: how far beyond the edge a finger that is swept off the high floor at 100 mm/s, 2 and 5 mm deep, has
//   lost half of its force; before the edge is negative. Root mean square, earliest and latest.
//   `worst`: the farther of these two.
// - `held`: places at which it still had it 8 mm beyond; they count as 8 mm.
// The finger's speeds are against the edge. A quick run is the same: it takes seconds.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureEdges(const MeasureOptions& options);

}  // namespace relievo
