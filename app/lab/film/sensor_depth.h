// SPDX-License-Identifier: Apache-2.0
// Simulates depth as a camera sees it: noise, salt, holes, and flying samples at edges.
#pragma once

#include <cstdint>

#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

struct SensorModel {
  double noise_levels = 2;  // standard deviation, in codes of 8 bits
  // Salt: one sample in 500 gets a random code. Holes: discs of one to four samples in diameter, 1 % of the picture.
  // Flying samples: half of those beside a step lie anywhere between its two sides.
  bool faults = false;
};

// 8-bit codes, full range, near high; 0 is a hole.
inline const DepthCalibration kSensorCalibration{.bits = 8, .invalid = 0};

// `exact` must be a gray frame of 16 bits, full range, near high. Equal seeds give equal pictures.
[[nodiscard]] Frame sensedDepth(const Frame& exact, const SensorModel& sensor, std::uint64_t seed);

// Reduces 16 bits, code 0 a hole, to 8 bits of the same meaning, as an 8-bit encoder does with enhanced depth.
[[nodiscard]] Frame asEightBits(const Frame& wide);

}  // namespace relievo
