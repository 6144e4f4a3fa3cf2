// SPDX-License-Identifier: Apache-2.0
// Hands the frames of a film in memory to the haptic side as a player does, and as one does that is in trouble.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "app/depth_window/shots.h"
#include "app/depth_window/surface_window.h"

namespace relievo {

// The window holds the frames from two before the present one to four after it, as far as they have come by then. A
// frame that comes late takes its place in the order of time; one that is over when it comes is never seen.
class MemoryFeed {
 public:
  static constexpr int kBefore = SurfaceWindow::kBefore, kAhead = SurfaceWindow::kAhead;
  // Whether a frame of the film can be had, at a time of the machine; nothing: all of them, always.
  using Supply = std::function<bool(std::size_t frame, double machine_s)>;

  // `film` outlives it.
  explicit MemoryFeed(std::span<const TimedSurface> film, Supply supply = {})
      : film_(film), supply_(std::move(supply)) {}

  // The frames around `now`; true when they are not those of the last call: then `window` holds them. A new epoch
  // forgets what was there.
  [[nodiscard]] bool update(MediaTime now, double machine_s, std::uint32_t epoch, SurfaceWindow& window);

 private:
  [[nodiscard]] std::vector<std::size_t> wanted(MediaTime now, double machine_s) const;

  std::span<const TimedSurface> film_;
  Supply supply_;
  ShotFinder shots_;
  std::vector<TimedSurface> held_;
  std::vector<std::size_t> indices_;  // of `held_` in the film
  std::uint32_t epoch_ = 0;
  bool first_ = true;
};

}  // namespace relievo
