// SPDX-License-Identifier: Apache-2.0
// Estimates the noise of a depth picture from the picture alone.
#pragma once

#include "app/enhance/depth_map.h"

namespace relievo {

// The standard deviation of noise that is independent between samples, in codes. Slopes and steps are excluded: it is
// the median over the picture of the second difference down of the second difference across. Includes the rounding of
// the codes. 0 if the picture has no 3 x 3 known samples.
[[nodiscard]] float noiseOf(const DepthMap& map);

}  // namespace relievo
