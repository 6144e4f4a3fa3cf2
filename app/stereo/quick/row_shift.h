// SPDX-License-Identifier: Apache-2.0
// By how many rows one view lies lower than the other, and by how much it is turned.
#pragma once

#include "app/stereo/view_picture.h"

namespace relievo {

// How far down what the left view shows lies in the right one, in rows and parts of one, up to a twentieth of them; 0
// if that is less than a row or not plain. The brightness of whole rows tells: what is near or far moves along them.
[[nodiscard]] double rowShift(const ViewPicture& left, const ViewPicture& right);

// By how many radians the right view is turned clockwise, up to two degrees: told by how far down its left third and
// its right one lie. 0 if that is less than a quarter of a degree or not plain.
[[nodiscard]] double turnBetween(const ViewPicture& left, const ViewPicture& right);

// Turns a view back about its middle; its border's pixels are repeated.
void turnBack(ViewPicture& view, double clockwise);

}  // namespace relievo
