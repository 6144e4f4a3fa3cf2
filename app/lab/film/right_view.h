// SPDX-License-Identifier: Apache-2.0
// Computes the right eye's picture of a scene from the left one and the exact disparity of each pixel.
#pragma once

#include <span>

#include "hal/media/frame.h"

namespace relievo {

// `left`: packed RGB of 8 bits. `disparity`: x in the left view minus x in the right one, in pixels, row by row. A jump
// of more than kCliff pixels between neighbours is an edge: the uncovered background gets the far side's colours,
// mirrored.
inline constexpr float kCliff = 1;
[[nodiscard]] Frame rightViewOf(const Frame& left, std::span<const float> disparity);

}  // namespace relievo
