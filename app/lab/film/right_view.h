// SPDX-License-Identifier: Apache-2.0
// The right eye's picture of a scene whose left one is known with the exact disparity of each pixel.
#pragma once

#include <span>

#include "hal/media/frame.h"

namespace relievo {

// `left`: packed RGB of 8 bits. `disparity`: x in the left view less x in the right one, in pixels, row by row. A jump
// of more than kCliff pixels between neighbours is an edge: what lies behind it shows the far side's colours, mirrored.
inline constexpr float kCliff = 1;
[[nodiscard]] Frame rightViewOf(const Frame& left, std::span<const float> disparity);

}  // namespace relievo
