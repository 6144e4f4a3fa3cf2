// SPDX-License-Identifier: Apache-2.0
// Assigns a disparity to points that only one eye sees or that could not be matched.
#pragma once

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// An occluded area, which the near side hides from the right eye, gets the disparity of its farther side. Other holes
// get that of the surrounding points that are most similar in colour. Afterwards every point has a disparity; `seen` is
// not changed.
void fillHoles(DisparityMap& map, const ViewPicture& left);

}  // namespace relievo
