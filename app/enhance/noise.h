// SPDX-License-Identifier: Apache-2.0
// How noisy a depth picture is, estimated from the picture alone.
#pragma once

#include "app/enhance/depth_map.h"

namespace relievo {

// The standard deviation of noise that is new at every sample, in codes. Slopes and steps do not count: it is what is
// left of the second difference across of the second difference down, by the median over the picture. The rounding of
// the codes counts, as much as it is. 0 for a picture without nine known samples side by side.
[[nodiscard]] float noiseOf(const DepthMap& map);

}  // namespace relievo
