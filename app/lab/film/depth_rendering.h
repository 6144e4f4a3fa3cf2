// SPDX-License-Identifier: Apache-2.0
// Depth frames of a true surface, as a decoder would give them.
#pragma once

#include <cstdint>
#include <vector>

#include "app/lab/truth/true_surface.h"
#include "hal/frame.h"

namespace relievo {

struct DepthFormat {
  int cols = 720, rows = 486;
  double frames_per_s = 30;
  int bits = 8;                  // 8 to 16; a calibration of these frames is DepthCalibration{.bits = bits}
  double noise_share = 0;        // standard deviation of Gaussian noise, in share of full scale
  std::uint64_t noise_seed = 1;  // the same seed, the same noise
};

// Frame `index` of a film that begins at time 0: S at the pixel centres and at exactly the frame's pts, in the linear
// law, near high, full range; the noise, if any, is added to every pixel of every frame anew; then the nearest code.
// A gray frame whose samples live as long as a copy of it.
[[nodiscard]] Frame renderDepth(const TrueSurface& surface, const DepthFormat& format, int index);
[[nodiscard]] std::vector<Frame> renderDepthFilm(const TrueSurface& surface, const DepthFormat& format, int count);

}  // namespace relievo
