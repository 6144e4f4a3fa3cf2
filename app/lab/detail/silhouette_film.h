// SPDX-License-Identifier: Apache-2.0
// The silhouette scene as a film of colour and depth, and as a ray-cast picture for each eye.
#pragma once

#include <cstdint>
#include <vector>

#include "app/lab/detail/picture_quality.h"
#include "app/render/relief/stereo.h"
#include "hal/media/frame.h"

namespace relievo {

struct SilhouetteFilm {
  static constexpr int kCols = 720, kRows = 486;
  static constexpr double kFramesPerSecond = 30;

  // 8 bits, linear, near high, full range: DepthCalibration{}.
  [[nodiscard]] static Frame depth(int index);
  [[nodiscard]] static Frame color(int index);
  // Ray cast on all processors, with `finer` squared rays for each pixel.
  [[nodiscard]] static DrawnPicture seen(int index, const EyeViews& eyes, int width, int height, int finer);

  // A picture to draw on the depth: white, but red within `reach` samples, across or down, of two neighbours whose
  // heights differ by more than 1 mm, and black at the picture's rim.
  [[nodiscard]] static Frame marks(const Frame& depth, int reach);
};

}  // namespace relievo
