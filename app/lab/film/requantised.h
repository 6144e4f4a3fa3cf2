// SPDX-License-Identifier: Apache-2.0
// Reduces exact depth to fewer steps, spaced in one of several ways, and measures the height error.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "hal/media/frame.h"

namespace relievo {

enum class DepthSteps : std::uint8_t {
  Even,
  Dithered,      // evenly spaced, with an 8 x 8 ordered dither pattern added before rounding
  Disparity,     // spaced by the inverse law: finest near the viewer
  Hue,           // 4:2:0 in colours, as recorders paint depth: red nearest
  HueDisparity,  // hue of the inverse law, red farthest, as RealSense paints it
  Turbo
};
[[nodiscard]] const char* name(DepthSteps steps) noexcept;

// The calibration of the reduced codes.
[[nodiscard]] DepthCalibration meaningOf(int bits, DepthSteps steps) noexcept;
// `depth`: gray of 16 bits, linear, near high, full range.
[[nodiscard]] Frame requantised(const Frame& depth, int bits, DepthSteps steps);

// Accumulates over all samples of pictures of one size.
class HeightErrorSum {
 public:
  void add(const HeightField& felt, const HeightField& truth);
  [[nodiscard]] double rms() const noexcept { return count_ > 0 ? std::sqrt(squares_ / count_) : 0; }
  [[nodiscard]] double largest() const noexcept { return largest_; }

 private:
  double squares_ = 0, largest_ = 0, count_ = 0;
};

}  // namespace relievo
