// SPDX-License-Identifier: Apache-2.0
// Distinguishes depth that a lossy codec has changed from depth that was only rounded.
#pragma once

#include <span>

#include "app/depth_window/surface_window.h"

namespace relievo {

// A higher step is an edge, a lower one is rounding.
inline constexpr double kEdgeMm = 3.0, kRoundingMm = 1e-6;

// The share of the steps between neighbouring samples at which the depth changes direction, from up to down or back,
// for the second time within twelve samples. A smooth surface that was rounded changes direction once, at the top of
// each hill; a codec's ripples and noise do so again at once. Steps over an edge do not count. 0 without steps. Reads
// 32 rows and 32 columns of each frame, at most 1024 samples of each.
[[nodiscard]] double ripplesOf(std::span<const TimedSurface> frames);

}  // namespace relievo
