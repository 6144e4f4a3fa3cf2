// SPDX-License-Identifier: Apache-2.0
// Gaussian smoothing that stops at steps and leaves slopes as they are.
#pragma once

#include "app/enhance/depth_map.h"

namespace relievo {

// Every sample becomes the value of a line that is fitted to those up to `reach` before and behind it, first along its
// row, then along its column, and both once more: nearly a Gaussian of 1.15 (reach + 1/2) standard deviation. No line
// goes on over a step (DepthMap::kStep), a hole or the picture's rim. Near those it is fitted to the side that is
// left, so that a plane comes out as it went in, right up to its edge.
void fitLines(DepthMap& map, int reach);

}  // namespace relievo
