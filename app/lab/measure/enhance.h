// SPDX-License-Identifier: Apache-2.0
// The effect of enhancement on touch: force, edges and mesh points, on surfaces of known shape as a camera would see
// them.
#pragma once

#include <vector>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Charts: enhance (the force's error by noise, and where edges are), enhance-points (points of a mesh by error bound).
[[nodiscard]] Outcome<std::vector<ChartWords>> measureEnhancement(const MeasureOptions& options);

}  // namespace relievo
