// SPDX-License-Identifier: Apache-2.0
// What depth from two views costs and what it is worth to the finger, by matcher and film.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Leaves stereo.csv: a row for each matcher and film of two views. The films are rendered from exactly known surfaces
// that move to the viewer and back, with the exact disparity of each pixel; one film is changed in one thing at a time:
// size, baseline, quality of the codec, texture. `relievo` feels the depth that a matcher makes of all pictures, and
// its force is held against the exact one; `exact` is the depth that was rendered. Times are of the processor, of all
// threads together. `marked`: `author` for what relievo-author does, `player` for the largest size that the player
// holds within its share of a picture's time on this machine.
// A quick run is of one scene, small views and half a second.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureStereo(const MeasureOptions& options);

}  // namespace relievo
