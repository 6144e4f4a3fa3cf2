// SPDX-License-Identifier: Apache-2.0
// The parts that a method of touch is made of, by name: how the surface lies between samples and between frames.
#pragma once

#include <cstdint>

namespace relievo {

// How a surface lies between two frames, and how many frames after the next one it looks ahead for that.
enum class TimeLaw : std::uint8_t {
  Hold,     // the newest frame as it is
  Linear,   // between the frame before and the buffered next one (paper, eq. 1)
  BSpline,  // cubic B-spline on the frames: smooth to the second derivative, but a low-pass; 1 more frame ahead
  Fitted,   // cubic spline that stays with the frames to the fourth order (quasi-interpolation); 2 more ahead
};
[[nodiscard]] const char* name(TimeLaw law) noexcept;  // hold linear bspline fitted

// How a surface lies between samples.
enum class SpaceLaw : std::uint8_t {
  Triangles,  // the paper's: each cell split by its diagonal
  Quadratic,  // quadratic B-spline on block means: continuous slope
  BSpline,    // cubic B-spline on block means: continuous curvature
};

}  // namespace relievo
