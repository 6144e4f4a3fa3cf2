// SPDX-License-Identifier: Apache-2.0
// What a film's depth means, for a viewer.
#pragma once

#include <string>

#include "app/scene/depth_calibration.h"

namespace relievo {

// "brighter is nearer, in 256 steps"; "distances from 400 to 1500 mm"; "the hue: red is near".
[[nodiscard]] std::string depthSentence(const DepthCalibration& calibration);

}  // namespace relievo
