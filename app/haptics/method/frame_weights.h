// SPDX-License-Identifier: Apache-2.0
// The surface in time: how much each frame of the window counts at a moment.
#pragma once

#include <array>

#include "app/depth_window/parts.h"
#include "app/depth_window/surface_window.h"
#include "hal/media_time.h"
#include "platform/realtime.h"

namespace relievo {

// Where a moment lies among the frames of a window.
struct FrameMoment {
  int present = -1;         // index of the newest frame whose time has come; -1: no frame at all
  int first = 0, last = 0;  // of the present frame's shot, inside the window
  double share = 0;         // of the way to the next frame, 0 .. 1

  FrameMoment() = default;
  FrameMoment(const SurfaceWindow& window, MediaTime now) RELIEVO_RT;
};

// S(t) = sum over i of weight[i] x frame i. The weights sum to 1 and are zero but for the frames around the present
// one, at most six. A frame that the window does not hold, or that lies beyond a cut, is stood in for by the nearest
// one on this side: the first and the last frame of a shot hold.
using FrameWeights = std::array<float, SurfaceWindow::kCapacity>;
[[nodiscard]] FrameWeights frameWeights(const FrameMoment& moment, TimeLaw law) RELIEVO_RT;

}  // namespace relievo
