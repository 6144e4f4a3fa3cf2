// SPDX-License-Identifier: Apache-2.0
// Interpolation laws of a touch method: the surface between samples and between frames.
#pragma once

#include <cstdint>

namespace relievo {

// Interpolation between two frames; some laws need frames beyond the next one.
enum class TimeLaw : std::uint8_t {
  Hold,     // the newest frame, unchanged
  Linear,   // from the present frame to the buffered next one (paper, eq. 1)
  BSpline,  // cubic B-spline over the frames: smooth to the second derivative, but a low-pass; needs 1 more frame
  Fitted,   // cubic quasi-interpolating spline: reproduces the frames to the fourth order; needs 2 more
  Adapted,  // the B-spline, and what the fitted spline adds to it where that is more than noise; needs 2 more
  Mean,     // the mean of five frame periods around the present: for frames that flicker; needs 2 more
};
[[nodiscard]] const char* name(TimeLaw law) noexcept;  // hold linear bspline fitted adapted mean

// The surface between samples.
enum class SpaceLaw : std::uint8_t {
  Triangles,  // the paper's: each cell is split by its diagonal
  Quadratic,  // quadratic B-spline on block means: continuous slope
  BSpline,    // cubic B-spline on block means: continuous curvature
};

}  // namespace relievo
