// SPDX-License-Identifier: Apache-2.0
// The chart of speed against accuracy, and what goes with it: by scene, by part, by finger speed and picture size.
#pragma once

#include <vector>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Charts: speed-accuracy, accuracy-by-scene, parts, tick-time.
// speed-accuracy.csv has all figures, one row per method or part, kind of depth, scene ("all": the accuracy scenes put
// together, timed on the nodding face), size, finger speed, warm or cold caches; what was not measured is empty.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureSpeedAndAccuracy(const MeasureOptions& options);

}  // namespace relievo
