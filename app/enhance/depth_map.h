// SPDX-License-Identifier: Apache-2.0
// The picture that is enhanced: depth of any kind in one form, with room for fractions of a code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// Codes are 65535 s, s being the normalised code (see DepthCalibration) with near high: every code of 8 to 16 bits has
// one of its own. A level is one of 255, the step of 8-bit depth.
struct DepthMap {
  static constexpr int kBits = 16;
  static constexpr float kHighest = 65535;
  static constexpr float kLevel = kHighest / 255;
  // Where neighbours differ by more, one thing ends before another: 80 degrees on a picture 720 samples wide.
  static constexpr float kStep = 8 * kLevel;

  int cols = 0, rows = 0;
  std::vector<float> codes;         // row by row; at a hole 0
  std::vector<std::uint8_t> holes;  // 1: nobody knows

  DepthMap() = default;
  DepthMap(int width, int height) : cols(width), rows(height), codes(size()), holes(size()) {}
  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(cols) * rows; }
  [[nodiscard]] std::size_t at(int c, int r) const noexcept { return static_cast<std::size_t>(r) * cols + c; }
};

// Unsupported for a frame that has not what the calibration speaks of.
[[nodiscard]] Result<DepthMap> readDepth(const Frame& depth, const DepthCalibration& calibration);

// Of a relief, by its heights.
[[nodiscard]] DepthMap mapOf(const HeightField& field);

// A gray frame of 16 bits with the times and the shape of `like`; its codes mean `recoded(source, DepthMap::kBits)`.
[[nodiscard]] Frame writeDepth(const DepthMap& map, bool may_have_holes, const Frame& like);

}  // namespace relievo
