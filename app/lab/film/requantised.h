// SPDX-License-Identifier: Apache-2.0
// Exact depth in fewer steps, laid in one way or another; and how far heights are off then.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "hal/frame.h"

namespace relievo {

enum class DepthSteps : std::uint8_t {
  Even,
  Dithered,   // even, an ordered pattern of 8 by 8 samples added before the rounding
  Disparity,  // by the inverse law: fine where it is near
};
[[nodiscard]] const char* name(DepthSteps steps) noexcept;

// What codes of such steps mean.
[[nodiscard]] DepthCalibration meaningOf(int bits, DepthSteps steps) noexcept;
// `depth`: gray of 16 bits, linear, near high, full range.
[[nodiscard]] Frame requantised(const Frame& depth, int bits, DepthSteps steps);

// Over all samples of pictures of one size.
class HeightErrorSum {
 public:
  void add(const HeightField& felt, const HeightField& truth);
  [[nodiscard]] double rms() const noexcept { return count_ > 0 ? std::sqrt(squares_ / count_) : 0; }
  [[nodiscard]] double largest() const noexcept { return largest_; }

 private:
  double squares_ = 0, largest_ = 0, count_ = 0;
};

}  // namespace relievo
