// SPDX-License-Identifier: Apache-2.0
// What detail of the drawn relief costs and buys: triangles and time against the errors of picture and touch.
#pragma once

#include <vector>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Chart: detail, a row of the CSV per kind of depth and level: the irregular network with an error of so many pixels,
// or the uniform grid of every so many samples.
// - Picture: side by side on 1280x720, over pictures of a film with silhouettes, without the bars beside it.
//   `away`: against the grid of all samples at three times the size, averaged down, without the pixels near
//   silhouettes; there that grid is no measure, since it stretches its triangles from the near to the far side; `whole`
//   has them. `truth`: the whole picture against what either eye would see of the things themselves, what lies behind
//   one another and all. No level can reach that: what is hidden from the front is not in the film.
// - Time: `frame` of a new picture, `draw` of the same once more, `mesh` what lies between them: uploads, and the
//   network's triangles. The least of some rounds, over the pictures in the mean; with GL in software the processor's.
// - Touch: error of relievo's force on a nodding face, against the oracle, where the finger feels the level's triangles
//   instead of the depth.
// `options.display` is needed. A quick run is of one picture and 8 bits.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureDetail(const MeasureOptions& options);

}  // namespace relievo
