// SPDX-License-Identifier: Apache-2.0
// The surface in time: the weight of each frame of the window at a given moment.
#pragma once

#include <array>

#include "app/depth_window/parts.h"
#include "app/depth_window/surface_window.h"
#include "hal/media/media_time.h"
#include "platform/realtime.h"

namespace relievo {

// The position of a moment among the frames of a window.
struct FrameMoment {
  int present = -1;         // index of the newest frame that is due; -1: none
  int first = 0, last = 0;  // the present frame's shot, within the window
  double share = 0;         // progress towards the next frame, 0 .. 1

  FrameMoment() = default;
  FrameMoment(const SurfaceWindow& window, MediaTime now) RELIEVO_RT;
};

// S(t) = sum over i of weight[i] x frame i. The weights sum to 1; at most six frames around the present one have one. A
// frame that the window lacks, or that lies beyond a cut, is replaced by the nearest frame on this side: the first and
// last frame of a shot are held.
using FrameWeights = std::array<float, SurfaceWindow::kCapacity>;
[[nodiscard]] FrameWeights frameWeights(const FrameMoment& moment, TimeLaw law) RELIEVO_RT;
// For a surface that is extrapolated in time: its position, and its position a duration `carried` later at its present
// rate, S + carried dS/dt. Both sum to 1. The rate is that of the two periods around the moment, interpolated between
// them, so that it is continuous and needs no frame beyond those of Linear.
[[nodiscard]] FrameWeights carriedWeights(const SurfaceWindow& window, const FrameMoment& moment, TimeLaw law,
                                          Duration carried) RELIEVO_RT;
// How many frames after the present one have a weight, at most.
[[nodiscard]] constexpr int framesAhead(TimeLaw law) RELIEVO_RT {
  return law == TimeLaw::Mean ? 3 : static_cast<int>(law);  // hold 0, linear 1, bspline 2, fitted 3
}
static_assert(framesAhead(TimeLaw::Mean) < SurfaceWindow::kAhead, "the writer may come late by a frame");

}  // namespace relievo
