// SPDX-License-Identifier: Apache-2.0
// Renders depth frames of an exactly known surface, as a decoder would deliver them.
#pragma once

#include <cstdint>
#include <vector>

#include "app/lab/truth/true_surface.h"
#include "hal/media/frame.h"

namespace relievo {

struct DepthFormat {
  int cols = 720, rows = 486;
  double frames_per_s = 30;
  int bits = 8;                  // 8 to 16 bits; their calibration is DepthCalibration{.bits = bits}
  double noise_share = 0;        // standard deviation of Gaussian noise, as a share of full scale
  std::uint64_t noise_seed = 1;  // equal seeds give equal noise
};

// Frame `index` of a film that begins at time 0: S at the pixel centres at exactly the frame's timestamp, linear law,
// near high, full range. Each pixel of each frame gets new noise, if any, and is then rounded to the nearest code. A
// gray frame whose samples live as long as a copy of it.
[[nodiscard]] Frame renderDepth(const TrueSurface& surface, const DepthFormat& format, int index);
[[nodiscard]] std::vector<Frame> renderDepthFilm(const TrueSurface& surface, const DepthFormat& format, int count);

}  // namespace relievo
