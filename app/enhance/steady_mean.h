// SPDX-License-Identifier: Apache-2.0
// Less flicker: a picture and those before and after it as one, where they belong together.
#pragma once

#include <span>

#include "app/enhance/depth_map.h"

namespace relievo {

// Each sample of `present` becomes the mean of itself and of pairs, one sample as long before as the other is after: a
// surface that moves steadily is where it was, without a lag. A pair counts where its middle is within `alike` of the
// present sample: not where an edge has passed, nor over a cut. `before` and `after` begin
// with the nearest; those without a partner do not count. All are of one size.
[[nodiscard]] DepthMap steadyMean(const DepthMap& present, std::span<const DepthMap* const> before,
                                  std::span<const DepthMap* const> after, float alike);

}  // namespace relievo
