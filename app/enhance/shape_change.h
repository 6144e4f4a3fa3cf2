// SPDX-License-Identifier: Apache-2.0
// Measures how enhancement changed the shape, from the depth before and after it.
#pragma once

#include <vector>

#include "app/enhance/depth_map.h"

namespace relievo {

inline constexpr int kShapeBlock = 8;  // samples across and down: averaging a block divides the noise by 8

// The means of the blocks, row by row; NaN if a block has a hole.
[[nodiscard]] std::vector<float> blockMeans(const DepthMap& map);

// The rms change of the block means, in codes. Blocks with a hole or a step are excluded: there samples change sides,
// which is not an error of height. 0 if no block remains.
[[nodiscard]] float shapeChange(const std::vector<float>& means_before, const DepthMap& after);

}  // namespace relievo
