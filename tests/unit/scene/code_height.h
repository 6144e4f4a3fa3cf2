// SPDX-License-Identifier: Apache-2.0
// The height that one depth code means in a volume of known size.
#pragma once

#include <cstdint>

#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "tests/support/film/depth_frames.h"

namespace relievo::test {

inline constexpr DisplayVolume kVolume{160, 108, 40};

inline double heightOf(std::uint32_t code, int bits, const DepthCalibration& calibration) {
  const Frame frame = makeGrayFrame(1, 1, bits, {}, [&](int, int) { return code; });
  return HeightField::make(frame, calibration, kVolume).value().heightMm(0, 0);
}

}  // namespace relievo::test
