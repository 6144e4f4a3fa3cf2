// SPDX-License-Identifier: Apache-2.0
// The smoothness of the force, after section VI of the paper: its spectrum while a finger is held on a nodding face.
#pragma once

#include <vector>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Charts: smoothness and smoothness-hand (spectra, a column of the CSV per curve, in dB re 1 N^2/Hz), smoothness-peaks
// (a row per curve: its peak at the frame rate, how far that is under holding the frame, error, look-ahead).
// The whole picture is rendered, 720x486; each of the ten segments of 10 s is a film of its own with 2 s before it in
// which the finger comes in.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureSmoothness(const MeasureOptions& options);

}  // namespace relievo
