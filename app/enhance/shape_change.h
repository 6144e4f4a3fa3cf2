// SPDX-License-Identifier: Apache-2.0
// What enhancement did to the shape, told from the depth before and after it alone.
#pragma once

#include <vector>

#include "app/enhance/depth_map.h"

namespace relievo {

inline constexpr int kShapeBlock = 8;  // samples across and down: noise is an eighth in the mean over a block

// The means of the blocks, row by row; not a number where a block has a hole.
[[nodiscard]] std::vector<float> blockMeans(const DepthMap& map);

// By how many codes the means of the blocks differ from what they were, rms. Blocks with a hole or a step do not count:
// there samples change sides, which is no matter of height. 0 where none is left.
[[nodiscard]] float shapeChange(const std::vector<float>& means_before, const DepthMap& after);

}  // namespace relievo
