// SPDX-License-Identifier: Apache-2.0
// Reasons why a film's reading is unlikely to be right.
#pragma once

#include <string>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

// One line each, with the share of samples and the option to try. `color`: the picture beside the depth, if it is one
// of its own; null if both are halves of one picture.
[[nodiscard]] std::vector<std::string> doubtsOf(const Frame& depth, const DepthCalibration& calibration,
                                                const Frame* color = nullptr);

}  // namespace relievo
