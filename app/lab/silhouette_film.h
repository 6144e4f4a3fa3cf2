// SPDX-License-Identifier: Apache-2.0
// A made film of colour and depth with silhouettes, for measuring pictures: a mask nods before a draped wall, a ball
// flies past it, a rod leans over both.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/frame.h"

namespace relievo {

struct SilhouetteFilm {
  static constexpr int kCols = 720, kRows = 486;
  static constexpr double kFramesPerSecond = 30;

  // 8 bits, linear, near high, full range: DepthCalibration{}.
  [[nodiscard]] static Frame depth(int index);
  // Light on coloured surfaces whose patterns are 2.6 mm long and longer, nine samples of it, so that what is lost in
  // drawing a picture is lost by its shape and not between its pixels.
  [[nodiscard]] static Frame color(int index);
};

// Within `reach` samples, across or down, of two neighbours whose heights differ by more than 1 mm: 1 there, row by
// row. `depth` as of the film.
[[nodiscard]] std::vector<std::uint8_t> nearSilhouettes(const Frame& depth, int reach);

}  // namespace relievo
