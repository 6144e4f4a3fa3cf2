// SPDX-License-Identifier: Apache-2.0
// The age of a live film's felt surface and the error of its force, by the number of frames that it waits for.
#pragma once

#include <vector>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Chart: latency (a row per rate, kind of depth, and surface: held, with 1 to 5 frames of look-ahead, carried forward
// by half a period and a whole one, and what the player chooses). Frames come from a camera with 5 ms of jitter.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureLatency(const MeasureOptions& options);

}  // namespace relievo
