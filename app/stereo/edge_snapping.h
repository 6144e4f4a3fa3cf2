// SPDX-License-Identifier: Apache-2.0
// Moves the steps of a disparity map to the outlines that the colours show.
#pragma once

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// The map has no holes. Pixels near a step, and those that were not seen, choose among the disparities around them: by
// how well each fits the right view and how like its pixels are in colour.
void snapEdges(DisparityMap& map, const ViewPicture& left, const ViewPicture& right);

}  // namespace relievo
