// SPDX-License-Identifier: Apache-2.0
// Whether a picture's depth lies beyond the near and far that were read from the first pictures. Pure.
#pragma once

#include <optional>
#include <string>

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

// Nullopt if hardly any of the depth lies beyond them.
struct BeyondReach {
  double percent = 0;  // of the picture
  std::string option;  // what includes it, such as "--calibration near=MM,far=MM"; empty if no option does
};
[[nodiscard]] std::optional<BeyondReach> beyondReach(const Frame& picture, const DepthCalibration& calibration);

}  // namespace relievo
