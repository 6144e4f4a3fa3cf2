// SPDX-License-Identifier: Apache-2.0
// Depth as a camera would have seen it: noise, salt, holes, and samples that hang in the air at edges.
#pragma once

#include <cstdint>

#include "app/scene/depth_calibration.h"
#include "hal/frame.h"

namespace relievo {

struct SensorModel {
  double noise_levels = 2;  // standard deviation, in codes of 8 bits
  // Salt: one sample in 500 with any code. Holes: discs of one to four samples across each way, a hundredth of the
  // picture. Flying: half of the samples beside a step lie anywhere between its two sides.
  bool faults = false;
};

// Codes of 8 bits, full range, near high; 0 is a hole.
inline const DepthCalibration kSensorCalibration{.bits = 8, .invalid = 0};

// `exact` is a gray frame of 16 bits, full range, near high. The same seed, the same picture.
[[nodiscard]] Frame sensedDepth(const Frame& exact, const SensorModel& sensor, std::uint64_t seed);

// 16 bits, code 0 a hole, as 8 bits of the same meaning: what a coder of 8 bits makes of enhanced depth.
[[nodiscard]] Frame asEightBits(const Frame& wide);

}  // namespace relievo
