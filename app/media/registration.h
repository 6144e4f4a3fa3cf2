// SPDX-License-Identifier: Apache-2.0
// Reprojects a depth camera's picture into the view of the colour camera beside it.
#pragma once

#include <array>
#include <string_view>

#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// A pinhole camera without distortion. Focal lengths and principal point are in pixels of a picture of `cols` x `rows`;
// the centre of pixel (c, r) is at (c, r). A picture of another size shows the same view, scaled.
struct PinholeCamera {
  double cols = 0, rows = 0;
  double focal_x = 0, focal_y = 0;
  double center_x = 0, center_y = 0;
};

// Maps a point p of the depth camera's frame (x right, y down, z forward, mm) to rotation x p + translation in the
// colour camera's frame.
struct Registration {
  PinholeCamera depth, color;
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  std::array<double, 3> translation_mm{0, 0, 0};
  double unit_mm = 1;  // per depth code, or per unit of floating-point depth (Frame::value_per_code); 0: not given
};

// Reads the TOML that app/author/README.md describes. InvalidArgument names the rule that the text breaks.
[[nodiscard]] Result<Registration> parseRegistration(std::string_view toml);

// The distances as the colour camera would see them: as wide as the depth picture, in the colour's aspect ratio, 16
// bits, the same unit. Every sample is a small plate that faces the camera; where several cover a pixel the nearest
// wins, and where none does there is a hole. Unsupported unless the picture holds whole-number codes.
[[nodiscard]] Result<Frame> registered(const Frame& depth, const Registration& registration);

}  // namespace relievo
