// SPDX-License-Identifier: Apache-2.0
// Brings the picture of a depth camera into the view of the colour camera beside it.
#pragma once

#include <array>
#include <string_view>

#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// A pinhole camera without distortion. Focal lengths and principal point in pixels of a picture of `cols` x `rows`;
// the centre of the pixel (c, r) is at (c, r). A picture of another size sees the same, scaled.
struct PinholeCamera {
  double cols = 0, rows = 0;
  double focal_x = 0, focal_y = 0;
  double center_x = 0, center_y = 0;
};

// A point p of the depth camera's frame (x right, y down, z forward, mm) is rotation x p + translation in the colour
// camera's.
struct Registration {
  PinholeCamera depth, color;
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  std::array<double, 3> translation_mm{0, 0, 0};
  double unit_mm = 1;  // of a depth code; 0 is no value
};

// TOML: see the readme. InvalidArgument for what is no registration, with the rule that it breaks.
[[nodiscard]] Result<Registration> parseRegistration(std::string_view toml);

// A picture of distances as the colour camera would see it: as wide as the depth picture, in the shape of the colour's,
// 16 bits, of the same unit. Every sample is a small plate that faces the camera; where two cover a pixel the nearer
// one wins, and where none does there is a hole. Unsupported for what is no picture of whole-number codes.
[[nodiscard]] Result<Frame> registered(const Frame& depth, const Registration& registration);

}  // namespace relievo
