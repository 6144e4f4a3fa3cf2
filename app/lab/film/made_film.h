// SPDX-License-Identifier: Apache-2.0
// Short depth films in memory, made of a formula: a small piece of a picture, at the sample pitch of a whole one.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "app/depth_window/surface_window.h"
#include "app/scene/display_volume.h"

namespace relievo {

// Height over place and time: mm, s. Clamped to the volume.
using Relief = std::function<double(double x_mm, double y_mm, double t_s)>;

struct MadeFormat {
  static constexpr int kCols = 180, kRows = 122;
  static constexpr double kPitchMm = 160.0 / 720;  // of a picture 720 wide on the default volume
  static constexpr DisplayVolume kVolume{kCols * kPitchMm, kRows * kPitchMm, 40};

  double frames_per_s = 30;
  int bits = 16;
  double noise_share = 0;  // standard deviation on every sample of every frame, in share of full scale
  std::uint64_t seed = 1;
};

// Changes the codes of a frame before it is felt: row by row, `kCols` wide.
using Damage = std::function<void(int frame, std::vector<std::uint16_t>& codes)>;

// Frames at 0, 1/f, 2/f .. up to the first one at or after `duration_s`.
[[nodiscard]] std::vector<TimedSurface> makeFilm(const Relief& relief, const MadeFormat& format, double duration_s,
                                                 const Damage& damage = {});

}  // namespace relievo
