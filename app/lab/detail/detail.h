// SPDX-License-Identifier: Apache-2.0
// The costs and errors of drawing the relief with more or less detail: triangles and time, picture and touch.
#pragma once

#include <vector>

#include "app/lab/measure/measurement.h"

namespace relievo {

// Chart: detail, a row of the CSV per kind of depth and level: the irregular network with an error of so many pixels,
// or the uniform grid of every so many samples.
// - Picture: side by side on 1280x720, over pictures of a film with silhouettes, without the bars beside it.
//   `away`: against the grid of all samples, drawn at three times the size and averaged down, without the pixels
//   near silhouettes: there that grid stretches its triangles from the near to the far side and is no reference;
//   `whole` includes these pixels. `truth`: the whole picture against a ray-cast picture of the objects for each
//   eye. No level can reach that, since parts that are hidden from the front are not in the film.
// - Time: `frame` is a new picture, `draw` the same picture drawn again, `mesh` their difference: uploads, and the
//   network's triangles. The least of several rounds, averaged over the pictures; with software GL, processor time.
// - Touch: error of relievo's force on a nodding face, against the oracle, if the finger feels the level's triangles
//   instead of the depth.
// Needs `options.display`. A quick run uses one picture and 8 bits.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureDetail(const MeasureOptions& options);

}  // namespace relievo
