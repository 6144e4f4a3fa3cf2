// SPDX-License-Identifier: Apache-2.0
// The picture to enhance: any kind of depth in one form, with fractional codes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// Codes are 65535 s, where s is the normalised code (see DepthCalibration) with near high: every code of 8 to 16 bits
// maps to a different one. A level is 1/255, the step of 8-bit depth.
struct DepthMap {
  static constexpr int kBits = 16;
  static constexpr float kHighest = 65535;
  static constexpr float kLevel = kHighest / 255;
  // A larger difference between neighbours separates two objects: a slope of 80 degrees if the picture is 720 samples
  // wide.
  static constexpr float kStep = 8 * kLevel;

  int cols = 0, rows = 0;
  std::vector<float> codes;         // row by row; 0 at a hole
  std::vector<std::uint8_t> holes;  // 1: unknown

  DepthMap() = default;
  DepthMap(int width, int height) : cols(width), rows(height), codes(size()), holes(size()) {}
  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(cols) * rows; }
  [[nodiscard]] std::size_t at(int c, int r) const noexcept { return static_cast<std::size_t>(r) * cols + c; }
};

// Unsupported if the frame lacks the component that the calibration names.
[[nodiscard]] Result<DepthMap> readDepth(const Frame& depth, const DepthCalibration& calibration);

// From a relief's heights.
[[nodiscard]] DepthMap mapOf(const HeightField& field);

// A gray frame of 16 bits with the timestamps and aspect ratio of `like`; its codes mean `recoded(source,
// DepthMap::kBits)`.
[[nodiscard]] Frame writeDepth(const DepthMap& map, bool may_have_holes, const Frame& like);

}  // namespace relievo
