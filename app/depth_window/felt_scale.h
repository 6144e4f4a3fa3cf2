// SPDX-License-Identifier: Apache-2.0
// How wide the felt surface smooths and by which laws: what the plan picks and the method builds on.
#pragma once

#include "app/depth_window/parts.h"

namespace relievo {

// The standard deviation of a level's smoothing, in pitches of its control points: a box of one pitch under a cubic
// B-spline (variances 1/12 and 4/12 pitch^2). Under a quadratic one it is 0.577.
inline constexpr double kSigmaPerPitch = 0.645497;  // sqrt(5/12)

// About so many samples of a control point's block are read, across and down, for each level.
inline constexpr int kNarrowSamples = 3, kWideSamples = 5;

// How wide the surface looks around; standard deviations of the smoothing.
struct FeltScale {
  double narrow_mm = 0.28;  // what an edge is seen with
  double wide_mm = 0.72;    // what all else is seen with; not wider than narrow: one level is enough
  double clamp_mm = 0.25;   // how far the wide level may leave the narrow one
  TimeLaw narrow_time = TimeLaw::Linear;
  TimeLaw wide_time = TimeLaw::Fitted;
  SpaceLaw space = SpaceLaw::BSpline;  // Quadratic or BSpline
};

}  // namespace relievo
