// SPDX-License-Identifier: Apache-2.0
// Moves the steps of a disparity map to the outlines in the colour picture.
#pragma once

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// The map must have no holes. Each pixel near a step, and each that was not seen, chooses among the disparities around
// it: by how well each fits the right view, and how similar in colour its pixels are.
void snapEdges(DisparityMap& map, const ViewPicture& left, const ViewPicture& right);

}  // namespace relievo
