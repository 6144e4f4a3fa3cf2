// SPDX-License-Identifier: Apache-2.0
// Flicker: what all samples of a frame do together, at random, as in depth that was estimated picture by picture.
#pragma once

#include <span>

#include "app/depth_window/surface_window.h"

namespace relievo {

// Standard deviation in mm of the frames' common error, over the heights of the picture; 0 if there is none. Between
// two frames each height h changes by a h + b (fitted without the places that move by themselves). Of errors that are
// independent from frame to frame with the variance s^2, two such changes in a row differ by 6 s^2. A motion of the
// whole scene has changes that differ little or by the same sign, flicker's alternate: what does not alternate is not
// counted. Needs three frames of a shot; not for the real-time thread.
[[nodiscard]] double flickerMm(std::span<const TimedSurface> frames);

}  // namespace relievo
