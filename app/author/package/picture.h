// SPDX-License-Identifier: Apache-2.0
// The pictures that the encoders take: colour of 8 bits in 4:2:0, depth in one plane.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/media/frame.h"

namespace relievo {

// Planes without gaps between rows. Chroma planes are half as wide and high; width and height are even.
struct ColorPicture420 {
  int width = 0, height = 0;
  ColorRange range = ColorRange::Limited;
  ColorMatrix matrix = ColorMatrix::Unspecified;
  std::vector<std::uint8_t> y, u, v;
};

// Codes 0 .. 2^bits - 1, full range, near high; the film's settings give the bits.
struct DepthPicture {
  int width = 0, height = 0;
  std::vector<std::uint16_t> codes;
};

}  // namespace relievo
