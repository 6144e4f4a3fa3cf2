// SPDX-License-Identifier: Apache-2.0
// Single samples of a frame, and what their codes stand for.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/media/frame.h"

namespace relievo {

// The code of a component in its column `c` and row `r`, which for chroma are those of its own samples.
[[nodiscard]] inline std::uint32_t codeAt(const Frame& frame, const Component& component, int c, int r) noexcept {
  const Plane& plane = frame.planes[component.plane];
  const std::ptrdiff_t at = component.offset_bytes + std::ptrdiff_t{c} * component.step_bytes;
  return codeAt(component, plane.data + r * plane.stride_bytes + at);
}

// The component that stands for brightness: luma, or of RGB green.
[[nodiscard]] inline const Component& brightnessOf(const Frame& frame) noexcept {
  return frame.components[frame.model == ColorModel::Rgb ? 1 : 0];
}

// Whether black and white are 16 and 235 of 255. YUV is unless it says otherwise.
[[nodiscard]] inline bool isLimited(const Frame& frame) noexcept {
  return frame.range == ColorRange::Limited ||
         (frame.model == ColorModel::Yuv && frame.range == ColorRange::Unspecified);
}

}  // namespace relievo
