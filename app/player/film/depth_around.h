// SPDX-License-Identifier: Apache-2.0
// The depth of the present picture and of those after it, from the film to touch.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "app/depth_window/surface_window.h"
#include "hal/media/frame.h"

namespace relievo {

struct DepthAround {
  Frame present;  // of the picture on the screen; empty if it has none or touch is off
  std::array<Frame, SurfaceWindow::kAhead> ahead;
  std::size_t ahead_count = 0;
  Frame material;  // of the same pictures; empty where there is none
  std::array<Frame, SurfaceWindow::kAhead> material_ahead;
  std::optional<MediaTime> felt;  // live films: the moment that is felt, before the present picture's
  bool last = false;              // no picture follows those ahead
  bool expected = false;          // the film has depth and touch is on: an empty `present` is a fault
};

// The depth pictures that follow the one on the screen, as far as they are decoded. Frame i is that of the picture
// i + 1 after it; empty if that has none, or none yet.
struct DepthComing {
  static constexpr std::size_t kMost = 8;
  std::array<Frame, kMost> frames;
  std::size_t count = 0;
  bool last = false;  // no picture follows them
};

}  // namespace relievo
