// SPDX-License-Identifier: Apache-2.0
// Gaussian-like smoothing that stops at steps and preserves slopes.
#pragma once

#include "app/enhance/depth_map.h"

namespace relievo {

// Every sample becomes the value of a line fitted to the samples up to `reach` before and after it, first along its
// row, then along its column, and both again: close to a Gaussian with a standard deviation of 1.15 (reach + 1/2). A
// fit never crosses a step (DepthMap::kStep), a hole or the picture's border. Near those it uses the remaining side, so
// that a plane is preserved up to its edge.
void fitLines(DepthMap& map, int reach);

}  // namespace relievo
