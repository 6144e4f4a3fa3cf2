// SPDX-License-Identifier: Apache-2.0
// What enhancement does for touch: force, edges and points of a mesh, on surfaces of known shape that a camera has
// seen.
#pragma once

#include <vector>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Charts: enhance (the force's error by noise, and where edges are), enhance-points (points of a mesh by error bound).
[[nodiscard]] Outcome<std::vector<ChartWords>> measureEnhancement(const MeasureOptions& options);

}  // namespace relievo
