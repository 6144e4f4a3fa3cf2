// SPDX-License-Identifier: Apache-2.0
// Reads frames as the player does, as a relief: here linear and 65535 mm deep.
#include "app/enhance/depth_map.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace relievo {

Result<DepthMap> readDepth(const Frame& depth, const DepthCalibration& calibration) {
  DepthCalibration linear = calibration;
  linear.law = DepthLaw::Linear;
  const DisplayVolume volume{.width_mm = 1, .height_mm = 1, .depth_mm = static_cast<double>(DepthMap::kHighest)};
  const auto field = HeightField::make(depth, linear, volume);
  if (!field) return std::unexpected(field.error());
  return mapOf(*field);
}

DepthMap mapOf(const HeightField& field) {
  const double code_per_mm = static_cast<double>(DepthMap::kHighest) / field.depthMm();
  DepthMap map(field.cols(), field.rows());
  std::size_t i = 0;
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c, ++i) {
      const double height = field.heightMm(c, r);
      map.holes[i] = std::isnan(height) ? 1 : 0;
      map.codes[i] = std::isnan(height) ? 0 : static_cast<float>(height * code_per_mm);
    }
  }
  return map;
}

Frame writeDepth(const DepthMap& map, bool may_have_holes, const Frame& like) {
  const auto samples = std::make_shared<std::vector<std::uint16_t>>(map.size());
  const float lowest = may_have_holes ? 1 : 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const float code = std::clamp(map.codes[i], lowest, DepthMap::kHighest);
    (*samples)[i] = map.holes[i] != 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(std::lround(code));
  }
  Frame frame = grayFrame(samples, map.cols, map.rows);
  frame.pts = like.pts;
  frame.duration = like.duration;
  frame.sample_aspect = like.sample_aspect;
  return frame;
}

}  // namespace relievo
