// SPDX-License-Identifier: Apache-2.0
// Compares relievo with smoothing of one width for the whole picture, for every width.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Writes widths.csv: for each kind of depth, the force's error of a god-object on depth that was smoothed per frame
// with one width, of the first and of the third order (DepthSmoother), and that of `relievo` (no width, order 0).
// Scenes, finger and frames are those of AccuracyTable. `worst_percent` is that of the worst scene, `scene` its name;
// `mean_percent` is over all of them.
// A quick run uses three scenes and four widths.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureWidths(const MeasureOptions& options);

}  // namespace relievo
