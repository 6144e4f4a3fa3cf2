// SPDX-License-Identifier: Apache-2.0
// The stability map: every method in every scenario; and the stiffness from which closed loops swing, beside theory.
#pragma once

#include <vector>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Charts: stability (a cell per scenario and method, with the figure that decided it), guard-sensitivity (the paper's
// method by the threshold of its guard) and stability-onset (stiffness from which a device swings on a wall, over its
// delay at 1 kHz and over its rate with a force one tick late, with the bounds and Choi and Tan's measured law).
[[nodiscard]] Outcome<std::vector<ChartWords>> measureStability(const MeasureOptions& options);

}  // namespace relievo
