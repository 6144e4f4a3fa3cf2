// SPDX-License-Identifier: Apache-2.0
// A window's keys and mouse, passed from its display to the remote control and the pointer.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "drivers/window/scene_ray.h"
#include "hal/remote_input.h"
#include "platform/spsc_ring.h"
#include "platform/triple_buffer.h"

namespace relievo {

struct WindowMouse {
  std::optional<SceneRay> ray;  // what it points at; nullopt until it has been over the picture
  std::int32_t notches = 0;     // of the wheel, forward positive, since the window opened
  bool left = false, middle = false, right = false;
};

// Only the display's thread writes it. Keys have one reader, on any thread; the mouse has one, which may be the
// real-time thread. Keys are dropped while the ring is full.
struct WindowInput {
  static constexpr std::size_t kMostKeys = 64;

  std::atomic<bool> open{false};     // the window is open
  std::atomic<bool> focused{false};  // it has the desktop's keyboard
  SpscRing<KeyEvent, kMostKeys> keys;
  TripleBuffer<WindowMouse> mouse;
};

}  // namespace relievo
