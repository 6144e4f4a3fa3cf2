// SPDX-License-Identifier: Apache-2.0
// What detail of the drawn relief costs and buys: triangles and time against the errors of picture and touch.
#pragma once

#include <vector>

#include "app/lab/measurement.h"

namespace relievo {

// Chart: detail, a row of the CSV per kind of depth and level: the irregular network with an error of so many pixels,
// or the uniform grid of every so many samples.
// - Picture: side by side on 1280x720, against the grid of all samples at three times the size, averaged down; over
//   pictures of a film with silhouettes. Bars beside the picture do not count. `away`: nor do pixels near silhouettes,
//   where the grid stretches its triangles from the near to the far side and the network is cut: none of them is right
//   there, for what is behind was never recorded.
// - Time: medians over the pictures, levels taking turns; with GL in software it is the processor's.
// - Touch: error of relievo's force on a nodding face, against the oracle, where the finger feels the level's triangles
//   instead of the depth.
// `options.display` is needed.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureDetail(const MeasureOptions& options);

}  // namespace relievo
