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
// of the samples that are not black lie on any curve, or if they are of one colour. A picture that states no matrix is
// tried by BT.601 and by BT.709.
[[nodiscard]] std::optional<ColorMapFit> bestColorMap(const Frame& picture);

// The matrix of depth in this code's colours: as stated, else BT.601 or BT.709, by which its colours lie nearer to the
// code's curve. Unspecified if it shows nothing, or for luma.
[[nodiscard]] ColorMatrix matrixOf(const Frame& depth, DepthCode code);

}  // namespace relievo
