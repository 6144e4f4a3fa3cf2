// SPDX-License-Identifier: Apache-2.0
// Measures by how many rows one view lies lower than the other, and by how much it is turned.
#pragma once

#include "app/stereo/view_picture.h"

namespace relievo {

// How far down in the right view the content of the left one lies, in rows and fractions, up to a twentieth of the
// rows; 0 if that is less than a row or unclear. Compares the brightness of whole rows, which disparity only shifts
// sideways.
[[nodiscard]] double rowShift(const ViewPicture& left, const ViewPicture& right);

// The angle, in radians, by which the right view is turned clockwise, up to two degrees, from the vertical shifts of
// its left and right thirds. 0 if that is less than a quarter of a degree or unclear.
[[nodiscard]] double turnBetween(const ViewPicture& left, const ViewPicture& right);

// Turns a view back about its centre; its border pixels are repeated.
void turnBack(ViewPicture& view, double clockwise);

}  // namespace relievo
