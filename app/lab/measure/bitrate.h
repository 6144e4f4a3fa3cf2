// SPDX-License-Identifier: Apache-2.0
// The bit rate of coded depth, and the error in the force that the coding causes.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Writes bitrate.csv, a row for each codec, number of bits, kind of steps and crf, over all scenes:
//
// - `kbit_s`: the depth's, 720x486 at 30 frames/s, as relievo-author codes it.
// - `force_rms_percent`: error of relievo's force against the oracle, finger 5 mm deep at 0.1 m/s.
// - `god_object_rms_percent`, `god_object_smoothed_rms_percent`: of the same finger with these methods.
// - `height_rms_mm`, `height_max_mm`: of all samples, against depth of 16 bits.
// - `steps`: even; "disparity": by the inverse law, far four times as far as near; "dithered": even, with an ordered
//   pattern of half a step either way before they are rounded; "hue", "hue-disparity", "turbo": in colours, 4:2:0, as
//   recorders paint depth. A hole has no height error.
//
// Writes bitrate-ticks.csv: relievo's tick on one of the scenes as brightness and in colours, the median and p99.9 over
// ticks of each tick's median over the rounds.
// A quick run uses one scene and few qualities.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureBitrate(const MeasureOptions& options);

}  // namespace relievo
