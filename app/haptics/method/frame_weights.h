// SPDX-License-Identifier: Apache-2.0
// The surface in time: the weight of each frame of the window at a given moment.
#pragma once

#include <algorithm>
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
  // The same with the share of another time at which the present frame is the same.
  [[nodiscard]] FrameMoment at(const SurfaceWindow& window, MediaTime now) const RELIEVO_RT;
};

// S(t) = sum over i of weight[i] x frame(i). The weights sum to 1. A frame that the window lacks, or that lies beyond a
// cut, is replaced by the nearest frame on this side: the first and last frame of a shot are held.
struct FrameTaps {
  static constexpr std::size_t kCount = 6;
  alignas(16) std::array<float, 8> weight{};  // the last two have none

  FrameTaps() = default;
  FrameTaps(const FrameMoment& moment, TimeLaw law) RELIEVO_RT;
  // What the fitted spline adds to the B-spline; they sum to 0.
  [[nodiscard]] static FrameTaps addedByFitted(const FrameMoment& moment) RELIEVO_RT;
  // The index in the window.
  [[nodiscard]] static std::size_t frame(const FrameMoment& moment, int tap) RELIEVO_RT {
    return static_cast<std::size_t>(std::clamp(moment.present - 2 + tap, moment.first, moment.last));
  }
};
// The same by the window's frames.
using FrameWeights = std::array<float, SurfaceWindow::kCapacity>;
[[nodiscard]] FrameWeights frameWeights(const FrameMoment& moment, const FrameTaps& taps) RELIEVO_RT;
// For a surface that is extrapolated in time: its position, and its position a duration `carried` later at its present
// rate, S + carried dS/dt. Both sum to 1. The rate is that of the two periods around the moment, interpolated between
// them, so that it is continuous and needs no frame beyond those of Linear.
[[nodiscard]] FrameWeights carriedWeights(const SurfaceWindow& window, const FrameMoment& moment, TimeLaw law,
                                          Duration carried) RELIEVO_RT;
// How many frames after the present one have a weight, at most.
[[nodiscard]] constexpr int framesAhead(TimeLaw law) RELIEVO_RT {
  return std::min(static_cast<int>(law), 3);  // hold 0, linear 1, bspline 2, the others 3
}
static_assert(framesAhead(TimeLaw::Mean) < SurfaceWindow::kAhead, "the writer may come late by a frame");

}  // namespace relievo
