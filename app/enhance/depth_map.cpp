// SPDX-License-Identifier: Apache-2.0
// Reads frames as the player does, as a relief: here linear and 65535 mm deep.
#include "app/enhance/depth_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "app/enhance/in_bands.h"

namespace relievo {
namespace {

void set(DepthMap& map, std::size_t i, double code) {
  map.holes[i] = std::isnan(code) ? 1 : 0;
  map.codes[i] = std::isnan(code) ? 0 : static_cast<float>(code);
}

}  // namespace

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
  DepthMap map(field.cols(), field.rows()), by_code(static_cast<int>(field.codeCount()), 1);
  for (std::size_t code = 0; code < by_code.size(); ++code) {
    set(by_code, code, field.heightOfCode(static_cast<std::uint32_t>(code)) * code_per_mm);
  }
  inBands(map.rows, [&](int first, int end) {
    std::vector<std::uint16_t> codes(static_cast<std::size_t>(map.cols));
    for (int r = first; r < end; ++r) {
      std::size_t i = map.at(0, r);
      if (field.readCodes(r, codes)) {
        for (const std::uint16_t code : codes) {
          map.codes[i] = by_code.codes[code];
          map.holes[i++] = by_code.holes[code];
        }
        continue;
      }
      for (int c = 0; c < map.cols; ++c) set(map, i++, field.heightMm(c, r) * code_per_mm);
    }
  });
  return map;
}

Frame writeDepth(const DepthMap& map, bool may_have_holes, const Frame& like) {
  const auto samples = std::make_shared<std::vector<std::uint16_t>>(map.size());
  constexpr double kHalf = 0.5;  // codes are not negative
  const float lowest = may_have_holes ? 1 : 0;
  inBands(map.rows, [&](int first, int end) {
    const float* const codes = map.codes.data();
    const std::uint8_t* const holes = map.holes.data();
    std::uint16_t* const out = samples->data();
    for (std::size_t i = map.at(0, first); i < map.at(0, end); ++i) {
      const float code = std::min(std::max(codes[i], lowest), DepthMap::kHighest);
      const int rounded = static_cast<int>(kHalf + static_cast<double>(code));
      out[i] = static_cast<std::uint16_t>(holes[i] != 0 ? 0 : rounded);
    }
  });
  Frame frame = grayFrame(samples, map.cols, map.rows);
  frame.pts = like.pts;
  frame.duration = like.duration;
  frame.sample_aspect = like.sample_aspect;
  return frame;
}

}  // namespace relievo
