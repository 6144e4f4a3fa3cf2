// SPDX-License-Identifier: Apache-2.0
#include "app/lab/film/colored_depth.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/scene/color/color_curve.h"

namespace relievo {
namespace {

constexpr double kHighest = 65535;

// The normalised code of a height, as a share of the volume's depth.
double codeOf(double height, const DepthCalibration& meaning) {
  double s = height;
  if (meaning.law == DepthLaw::Inverse) {
    const double distance = meaning.far_mm - height * (meaning.far_mm - meaning.near_mm);
    s = (1 / distance - 1 / meaning.far_mm) / (1 / meaning.near_mm - 1 / meaning.far_mm);
  }
  return meaning.polarity == DepthPolarity::NearIsLow ? 1 - s : s;
}

std::uint8_t limited(float share, float span, float offset) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(offset + span * share, 0.0F, 255.0F)));
}

}  // namespace

Frame colored(const Frame& depth, const DepthCalibration& meaning) {
  const ColorCurve& curve = curveOf(meaning.code);
  const auto colorAt = [&](int c, int r) {
    const std::uint8_t* const at = depth.planes[0].data + r * depth.planes[0].stride_bytes + std::ptrdiff_t{2} * c;
    return curve.at(codeOf((at[0] | at[1] << 8) / kHighest, meaning));
  };
  const int cols = depth.width, rows = depth.height, luma = cols * rows;
  const auto samples = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(luma + luma / 2));
  std::uint8_t *y = samples->data(), *u = y + luma, *v = u + luma / 4;
  for (int r = 0; r < rows; r += 2) {
    for (int c = 0; c < cols; c += 2) {
      YuvColor sum;
      for (int k = 0; k < 4; ++k) {
        const YuvColor color = colorAt(c + k % 2, r + k / 2);
        y[(r + k / 2) * cols + c + k % 2] = limited(color.y, 219, 16);
        sum.u += color.u / 4;
        sum.v += color.v / 4;
      }
      *u++ = limited(sum.u, 224, 128);
      *v++ = limited(sum.v, 224, 128);
    }
  }
  Frame frame = depth;
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Limited;
  frame.matrix = ColorMatrix::Bt709;
  frame.chroma_shift_x = frame.chroma_shift_y = 1;
  frame.plane_count = 3;
  for (std::uint8_t i = 0; i < 3; ++i) {
    frame.components[i] = {.plane = i};
    frame.planes[i] = {samples->data() + (i == 0 ? 0 : luma + (i - 1) * luma / 4), i == 0 ? cols : cols / 2};
  }
  frame.owner = samples;
  return frame;
}

}  // namespace relievo
