// SPDX-License-Identifier: Apache-2.0
#include "app/media/depth_picture.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "app/scene/height_field.h"

namespace relievo {

Frame depthPicture(const Frame& depth, const DepthCalibration& calibration) {
  constexpr double kFarthest = 48, kNearest = 255;
  const auto cols = static_cast<std::size_t>(depth.width), rows = static_cast<std::size_t>(depth.height);
  auto samples = std::make_shared<std::vector<std::uint8_t>>(cols * rows);
  const auto field = HeightField::make(depth, calibration, {.width_mm = 1, .height_mm = 1, .depth_mm = 1});
  for (std::size_t i = 0; field && i < samples->size(); ++i) {
    const double height = field->heightMm(static_cast<int>(i % cols), static_cast<int>(i / cols));
    if (!std::isnan(height)) (*samples)[i] = static_cast<std::uint8_t>(kFarthest + (kNearest - kFarthest) * height);
  }
  Frame gray;
  gray.pts = depth.pts;
  gray.duration = depth.duration;
  gray.width = depth.width;
  gray.height = depth.height;
  gray.range = ColorRange::Full;
  gray.sample_aspect = depth.sample_aspect;
  gray.plane_count = 1;
  gray.planes[0] = {samples->data(), depth.width};
  gray.owner = std::move(samples);
  return gray;
}

}  // namespace relievo
