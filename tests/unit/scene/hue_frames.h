// SPDX-License-Identifier: Apache-2.0
// Depth in hues, and a picture to write it into.
#pragma once

#include <array>
#include <cstdint>

#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/media/frame.h"
#include "tests/support/film/recorded_scene.h"

namespace relievo::test {

constexpr DepthCalibration kHue{.polarity = DepthPolarity::NearIsHigh, .code = DepthCode::Hue};
constexpr DisplayVolume kUnit{160, 108, 1};  // a height is a hue

using Rgb = std::array<double, 3>;

// Without samples.
inline Frame bt709Frame(int cols, int rows, std::uint8_t chroma_shift) {
  Frame frame;
  frame.width = cols;
  frame.height = rows;
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Full;
  frame.matrix = ColorMatrix::Bt709;
  frame.chroma_shift_x = frame.chroma_shift_y = chroma_shift;
  return frame;
}

}  // namespace relievo::test
