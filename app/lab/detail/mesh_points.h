// SPDX-License-Identifier: Apache-2.0
// How many points a mesh of a depth picture needs, by its error bound.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Measures the author's mesh on exact shapes in 16 bits and on the first pictures of `options.depth_films`. Writes
// enhance-points.csv.
[[nodiscard]] Outcome<ChartWords> measureMeshPoints(const MeasureOptions& options);

}  // namespace relievo
