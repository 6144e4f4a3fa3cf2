// SPDX-License-Identifier: Apache-2.0
// Short depth films in memory, computed from a formula: a small picture with the sample pitch of a full one.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "app/depth_window/surface_window.h"
#include "app/scene/display_volume.h"

namespace relievo {

// Height over position and time: mm, s. Clamped to the volume.
using Relief = std::function<double(double x_mm, double y_mm, double t_s)>;

struct MadeFormat {
  static constexpr int kCols = 180, kRows = 122;
  static constexpr double kPitchMm = 160.0 / 720;  // of a picture 720 samples wide on the default volume
  static constexpr DisplayVolume kVolume{kCols * kPitchMm, kRows * kPitchMm, 40};

  double frames_per_s = 30;
  int bits = 16;
  double noise_share = 0;  // standard deviation of the noise of every sample, as a share of full scale
  std::uint64_t seed = 1;
  bool zero_is_hole = false;  // code 0 is a hole; a relief above the far plane has it only where `Damage` sets it
};

// Alters the codes of a frame before it is used: row by row, `kCols` wide.
using Damage = std::function<void(int frame, std::vector<std::uint16_t>& codes)>;

// Frames at 0, 1/f, 2/f .. up to the first one at or after `duration_s`.
[[nodiscard]] std::vector<TimedSurface> makeFilm(const Relief& relief, const MadeFormat& format, double duration_s,
                                                 const Damage& damage = {});

// A film that is made at the first call and then kept for all callers, on any thread.
class KeptFilm {
 public:
  // As makeFilm. Only the duration may differ from call to call.
  [[nodiscard]] const std::vector<TimedSurface>& make(const Relief& relief, const MadeFormat& format, double duration_s,
                                                      const Damage& damage = {});

 private:
  std::mutex lock_;
  std::map<double, std::vector<TimedSurface>> by_duration_;
};

}  // namespace relievo
