// SPDX-License-Identifier: Apache-2.0
// Hands the frames of a film in memory to the haptic side as a player does, and as one does that is in trouble.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

#include "app/depth_window/surface_window.h"
#include "app/depth_window/window_frames.h"

namespace relievo {

// A frame that comes late takes its place in the order of time; one that the present moment has left behind is not
// seen.
class MemoryFeed {
 public:
  // Whether a frame of the film can be had, at a time of the machine; nothing: all of them, always.
  using Supply = std::function<bool(std::size_t frame, double machine_s)>;

  // `film`, in ascending order of time, outlives it.
  explicit MemoryFeed(std::span<const TimedSurface> film, Supply supply = {})
      : film_(film), supply_(std::move(supply)) {}

  // The frames around `now`; true when they are not those of the last call: then `window` holds them. A new epoch
  // forgets what was there.
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
