// SPDX-License-Identifier: Apache-2.0
// Tells depth whose steps a lossy codec has changed from depth that was only rounded.
#pragma once

#include <span>

#include "app/depth_window/surface_window.h"

namespace relievo {

// The share of the steps between neighbouring samples at which the depth turns, from up to down or back, for the second
// time within twelve samples. Rounded, a smooth surface turns once at the top of each hill; a codec's ripples and noise
// turn again at once. Steps over an edge do not count. 0 without steps. Reads 32 rows and 32 columns of each frame, at
// most 1024 samples of each.
[[nodiscard]] double ripplesOf(std::span<const TimedSurface> frames);

}  // namespace relievo
