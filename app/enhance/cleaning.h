// SPDX-License-Identifier: Apache-2.0
// What a sensor does to single samples is undone: holes, salt, samples that hang between two things, noise of a few.
#pragma once

#include <cstddef>

#include "app/enhance/depth_map.h"

namespace relievo {

struct CleaningCounts {
  std::size_t holes = 0;     // of the source
  std::size_t outliers = 0;  // samples that were like hardly any of their neighbours
  std::size_t filled = 0;    // of both
};

// Samples that are like fewer than three of the 24 around them become unknown. What is unknown is filled where it is
// narrower than a fortieth of the picture's width, and is a hole where it is wider: a guess is no measurement. What is
// filled goes on as the side does that most directions see, so that an edge goes straight through a hole. Beside a long
// hole it is the farther of two sides that are seen about alike: behind something near a camera does not see.
// `noise` is the standard deviation of the codes.
CleaningCounts fillHoles(DepthMap& map, float noise);

// The median of five by five samples. Near a step only the samples of the same side count, so that the step stays
// where it is, with its corners, and what hangs in between joins the side that most of them are on.
void filterByMedian(DepthMap& map, float noise);

}  // namespace relievo
