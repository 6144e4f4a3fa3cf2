// SPDX-License-Identifier: Apache-2.0
// The depth around the present picture, as the film hands it to the hand.
#pragma once

#include <array>
#include <cstddef>

#include "app/depth_window/surface_window.h"
#include "hal/frame.h"

namespace relievo {

struct DepthAround {
  Frame present;  // the depth of the picture on the screen; empty: there is none, or it may not be felt
  std::array<Frame, SurfaceWindow::kAhead> ahead;
  std::size_t ahead_count = 0;
  bool last = false;      // no picture comes after those ahead
  bool expected = false;  // the film has depth and it may be felt: an empty `present` is worth a word
};

}  // namespace relievo
