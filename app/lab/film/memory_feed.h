// SPDX-License-Identifier: Apache-2.0
// Feeds the frames of a film in memory to the haptic side as the player does, including late and missing frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "app/depth_window/surface_window.h"
#include "app/depth_window/window_frames.h"

namespace relievo {

// A late frame is inserted by its time; one that lies before the window is dropped.
class MemoryFeed {
 public:
  // Whether a frame of the film is available at a machine time; empty: all of them, always.
  using Supply = std::function<bool(std::size_t frame, double machine_s)>;

  // `film`, in ascending order of time, must outlive it.
  explicit MemoryFeed(std::span<const TimedSurface> film, Supply supply = {})
      : film_(film), supply_(std::move(supply)) {}

  // Puts the frames around `now` into `window` and returns true if they differ from those of the last call. A new epoch
  // forgets all frames.
  [[nodiscard]] bool update(MediaTime now, double machine_s, std::uint32_t epoch, SurfaceWindow& window);

 private:
  bool addFrames(MediaTime now, double machine_s);

  std::span<const TimedSurface> film_;
  Supply supply_;
  WindowFrames frames_;
  std::uint32_t epoch_ = 0;
  bool first_ = true;
};

}  // namespace relievo
