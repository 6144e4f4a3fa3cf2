// SPDX-License-Identifier: Apache-2.0
// Depth in hues, and a picture to write it into.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/media/frame.h"

namespace relievo::test {

constexpr DepthCalibration kHue{.polarity = DepthPolarity::NearIsHigh, .code = DepthCode::Hue};
constexpr DisplayVolume kUnit{160, 108, 1};  // a height is a hue

using Rgb = std::array<double, 3>;

// 0 to 1, from red over yellow.
inline Rgb hue(double s) {
  const auto part = [&](double n) { return std::clamp(std::abs(std::fmod(6 * s + n, 6) - 3) - 1, 0.0, 1.0); };
  return {part(0), part(4), part(2)};
}

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
