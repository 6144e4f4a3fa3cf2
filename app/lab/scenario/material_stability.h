// SPDX-License-Identifier: Apache-2.0
// The default method in all scenarios on surfaces with friction, and on softer and stiffer ones.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Writes stability-material.csv: `relievo` in all scenarios as it is, with friction .3, with half and with twice its
// stiffness, and with a texture.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureMaterialStability(const MeasureOptions& options);

}  // namespace relievo
