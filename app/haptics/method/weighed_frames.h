// SPDX-License-Identifier: Apache-2.0
// The frames of a window with their weights at a moment, by the cache slot that holds them.
#pragma once

#include <array>
#include <cstdint>

#include "app/haptics/method/control_grid.h"
#include "app/haptics/method/frame_weights.h"
#include "platform/realtime.h"

namespace relievo {

// The cache slot of each frame of the window.
struct FrameSlots {
  const SurfaceWindow* window = nullptr;
  std::array<std::uint8_t, ControlGrid::kFrames> of_frame{};
  std::array<std::uint8_t, ControlGrid::kFrames> frame{};
  std::uint32_t in_use = 0;  // one bit per slot
};

struct WeighedFrames {
  FrameMoment moment;
  TimeLaw law = TimeLaw::Hold;
  ControlGrid::Frames frames;
  alignas(16) ControlGrid::Weights added{};  // weights of what TimeLaw::Adapted may add
  alignas(16) ControlGrid::Weights later{};  // at a later moment, without what is added

  // `at_later`: a moment at which the present frame is the same.
  void weigh(TimeLaw by, const FrameSlots& slots, const FrameMoment& at, const FrameMoment& at_later) RELIEVO_RT;
};

}  // namespace relievo
