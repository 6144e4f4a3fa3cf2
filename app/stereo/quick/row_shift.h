// SPDX-License-Identifier: Apache-2.0
// By how many rows one view lies lower than the other.
#pragma once

#include "app/stereo/view_picture.h"

namespace relievo {

// How far down what the left view shows lies in the right one, in rows and parts of one, up to a twentieth of them; 0
// if that is less than a row or not plain. The brightness of whole rows tells: what is near or far moves along them.
[[nodiscard]] double rowShift(const ViewPicture& left, const ViewPicture& right);

}  // namespace relievo
