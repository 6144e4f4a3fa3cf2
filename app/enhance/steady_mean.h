// SPDX-License-Identifier: Apache-2.0
// Reduces flicker: averages a picture with those before and after it where they agree.
#pragma once

#include <span>

#include "app/enhance/depth_map.h"

namespace relievo {

// Each sample of `present` becomes the mean of itself and of pairs of samples, one as long before as the other is
// after, so that a surface in steady motion keeps its position without a lag. A pair counts if its mean is within
// `alike` of the present sample, which excludes passing edges and cuts. `before` and `after` begin with the nearest
// picture and are equally many. All have the same size. The mean may replace the codes of one of them.
void steadyMean(const DepthMap& present, std::span<const DepthMap* const> before,
                std::span<const DepthMap* const> after, float alike, std::span<float> mean);

}  // namespace relievo
