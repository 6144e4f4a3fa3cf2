// SPDX-License-Identifier: Apache-2.0
// What depth from two views costs, and how exact it is under a finger, by matcher and film.
#pragma once

#include "app/lab/measure/measurement.h"

namespace relievo {

// Writes stereo.csv: a row for each matcher and film of two views. The films are rendered from exactly known surfaces
// that move to the viewer and back, with the exact disparity of each pixel; each film differs from a base film in one
// thing: size, baseline, codec quality or texture. `relievo` feels the depth that a matcher makes of all pictures, and
// its force is compared with the exact one; `exact` is the rendered depth. Times are processor times of all threads
// together. `marked`: `author` for relievo-author's matcher, `player` for the largest size that the player can match on
// this machine within its share of a picture's time.
// A quick run uses one scene, small views and half a second.
[[nodiscard]] Outcome<std::vector<ChartWords>> measureStereo(const MeasureOptions& options);

}  // namespace relievo
