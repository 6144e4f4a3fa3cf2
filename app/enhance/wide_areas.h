// SPDX-License-Identifier: Apache-2.0
// Separates a depth picture's wide unknown areas, which stay holes, from the narrow ones, which are filled.
#pragma once

#include <cstdint>
#include <vector>

#include "app/enhance/depth_map.h"

namespace relievo {

// Returns 1 where a disc of `radius` samples fits into the area that `unknown` marks; one value for each sample of
// `map`.
std::vector<std::uint8_t> findWide(const std::vector<std::uint8_t>& unknown, const DepthMap& map, int radius);

}  // namespace relievo
