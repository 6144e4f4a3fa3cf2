// SPDX-License-Identifier: Apache-2.0
// What a window hears of its keys and its mouse, on the way from the display that has the window to who listens.
#pragma once

#include <atomic>
#include <cstdint>

#include "hal/remote_input.h"
#include "platform/spsc_ring.h"
#include "platform/triple_buffer.h"

namespace relievo {

struct WindowMouse {
  double right_px = 0, up_px = 0;  // of the window's middle
  int width_px = 0, height_px = 0;
  std::int32_t notches = 0;  // that the wheel was turned forward since the window opened
  bool left = false, middle = false, right = false;
};

// Filled on the display's thread alone, once for each window. Keys have one listener, on any thread; the mouse has one,
// which may be the real-time thread. Keys that nobody takes are dropped when the ring is full.
struct WindowInput {
  static constexpr std::size_t kMostKeys = 64;

  std::atomic<bool> open{false};  // there is a window
  SpscRing<KeyEvent, kMostKeys> keys;
  TripleBuffer<WindowMouse> mouse;
};

}  // namespace relievo
