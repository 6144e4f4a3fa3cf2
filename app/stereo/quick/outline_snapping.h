// SPDX-License-Identifier: Apache-2.0
// Enlarges a disparity map so that its steps lie where the picture's colours change.
#pragma once

#include "app/stereo/disparity_map.h"
#include "app/stereo/view_picture.h"

namespace relievo {

// `small` has no holes and was matched on `small_left`. `large` has the size of `left`; its disparities are in pixels
// of `left`. Where the small map is smooth it is interpolated; at a step each pixel takes the side whose colours are
// like its own (after joint bilateral upsampling: Kopf and others, SIGGRAPH 2007).
void enlarge(const DisparityMap& small, const ViewPicture& small_left, const ViewPicture& left, DisparityMap& large);

}  // namespace relievo
