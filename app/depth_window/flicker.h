// SPDX-License-Identifier: Apache-2.0
// Flicker: random changes that all samples of a frame share, as in depth that was estimated picture by picture.
#pragma once

#include <span>

#include "app/depth_window/surface_window.h"

namespace relievo {

// Standard deviation in mm of the frames' common error, over the heights of the picture; 0 if there is none. Between
// two frames, each height h changes by a h + b, which is fitted without the places that move by themselves. If the
// frames' errors are independent with variance s^2, two successive changes differ by a variance of 6 s^2. Flicker
// changes its sign; a motion of the whole scene keeps it or changes slowly, so only changes that alternate are counted.
// Needs three frames of a shot; not for the real-time thread.
[[nodiscard]] double flickerMm(std::span<const TimedSurface> frames);

}  // namespace relievo
