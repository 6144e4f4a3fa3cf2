// SPDX-License-Identifier: Apache-2.0
// Repairs single samples: fills holes, replaces salt and flying samples, and reduces noise by a median.
#pragma once

#include <cstddef>

#include "app/enhance/depth_map.h"

namespace relievo {

struct CleaningCounts {
  std::size_t holes = 0;     // in the source
  std::size_t outliers = 0;  // samples unlike nearly all of their neighbours
  std::size_t filled = 0;    // of holes and outliers
};

// Samples that resemble fewer than three of the 24 around them become unknown. An unknown area is filled if it is
// narrower than 1/40 of the picture's width; a wider one stays a hole, since a guess is not a measurement. The filling
// continues the surface that most directions see, so that an edge crosses a hole in a straight line. Beside a long hole
// it is the farther of two surfaces seen about equally often, because cameras miss what is behind a near object.
// `noise` is the standard deviation of the codes.
CleaningCounts fillHoles(DepthMap& map, float noise);

// The median of 5 x 5 samples. Near a step only the samples on the same side count, so that the step and its corners
// stay in place, and a flying sample joins the side that holds most of its neighbours.
void filterByMedian(DepthMap& map, float noise);

}  // namespace relievo
