// SPDX-License-Identifier: Apache-2.0
// Times of a scanner's depth pictures from the table of poses beside their folder.
#pragma once

#include "drivers/pictures/folder.h"

namespace relievo::pictures {

// Stray Scanner writes "odometry.csv" beside "depth": lines of TIMESTAMP, FRAME, .. in seconds. If `found` is that
// folder's series and each of its numbers has a line, gives its pictures these times as `color_values`.
void takeOdometryTimes(FoundPictures& found);

}  // namespace relievo::pictures
