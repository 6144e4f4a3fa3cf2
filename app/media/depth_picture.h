// SPDX-License-Identifier: Apache-2.0
// Draws depth as a gray picture, for a film that has no colour.
#pragma once

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

// 8-bit gray, full range: the nearer the brighter, holes black. All black if the depth cannot be read.
[[nodiscard]] Frame depthPicture(const Frame& depth, const DepthCalibration& calibration);

}  // namespace relievo
