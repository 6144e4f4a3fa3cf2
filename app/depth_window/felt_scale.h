// SPDX-License-Identifier: Apache-2.0
// Widths and interpolation laws of the felt surface: chosen by the plan, used by the method.
#pragma once

#include "app/depth_window/parts.h"

namespace relievo {

// Standard deviation of a level's smoothing, in pitches of its control points: a box of one pitch convolved with a
// cubic B-spline (variances 1/12 + 4/12 pitch^2). With a quadratic B-spline it is 0.577.
inline constexpr double kSigmaPerPitch = 0.645497;  // sqrt(5/12)

// Approximate number of samples read per control point's block, across and down, for each level.
inline constexpr int kNarrowSamples = 3, kWideSamples = 15, kBroadSamples = 10;

// Widths of the smoothing (standard deviations), and the laws of interpolation.
struct FeltScale {
  double narrow_mm = 0.28;  // of the narrow level, which keeps edges
  double wide_mm = 0.72;  // of the wide level, used away from edges; if not wider than narrow, only one level is built
  double middle_mm = 0;   // of the middle level, used at creases; if not wider than narrow, there is none
  double broad_mm = 0;  // of the broad level, used where the surface is straight; if not wider than wide, there is none
  double wide_even_mm = 0;   // up to this the relief is even for the wide level (Evenness), in mm; 0: everywhere
  double broad_even_mm = 0;  // the same for the broad level; 0: nowhere
  double clamp_mm = 0.25;    // how far the wide level may deviate from the narrow one
  // Of what the fitted spline adds to the B-spline in time: less than this is noise (TimeLaw::Adapted).
  double narrow_steady_mm = 0, wide_steady_mm = 0;
  TimeLaw narrow_time = TimeLaw::Linear;
  TimeLaw wide_time = TimeLaw::Fitted;
  SpaceLaw space = SpaceLaw::BSpline;  // Quadratic or BSpline
};

}  // namespace relievo
