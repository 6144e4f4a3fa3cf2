// SPDX-License-Identifier: Apache-2.0
// Depth painted as recorders paint it: hues, or a colour map, in 4:2:0.
#pragma once

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

// `depth`: gray of 16 bits, linear, near high, full range; an even number of columns and rows. The result is 8-bit
// 4:2:0 of BT.709, limited range; a chroma sample is the mean of four. `meaning`: a code other than luma, codes of the
// whole curve, no unit.
[[nodiscard]] Frame colored(const Frame& depth, const DepthCalibration& meaning);

}  // namespace relievo
