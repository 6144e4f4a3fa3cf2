// SPDX-License-Identifier: Apache-2.0
// What a mesh of depth takes: its points by its error bound.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// The author's mesh alone, of exact shapes in 16 bits and of the first pictures of `options.depth_films`. Writes
// enhance-points.csv.
[[nodiscard]] Outcome<ChartWords> measureMeshPoints(const MeasureOptions& options);

}  // namespace relievo
