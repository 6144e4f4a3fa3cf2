// SPDX-License-Identifier: Apache-2.0
// Which colour map, or the circle of hues, a picture's colours lie on.
#pragma once

#include <optional>

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

struct ColorMapFit {
  DepthCode code = DepthCode::Hue;
  double residual = 0;  // median distance of the samples from the curve, in units of full scale
  double share = 0;     // of the samples that are not black, those on the curve
};

// The best fit among about ten thousand evenly spaced samples. Nullopt if the picture is gray, if less than nine tenths
// of the samples that are not black lie on any curve, or if they are of one colour.
[[nodiscard]] std::optional<ColorMapFit> bestColorMap(const Frame& picture);

}  // namespace relievo
