// SPDX-License-Identifier: Apache-2.0
// Gives a disparity to the points that only one eye sees or that could not be matched.
#pragma once

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// A shadow, which the near side hides from the right eye, gets the disparity of its farther side. Other holes get that
// of the points around that are most like them in colour. Nothing is left out; `seen` stays as it is.
void fillHoles(DisparityMap& map, const ViewPicture& left);

}  // namespace relievo
