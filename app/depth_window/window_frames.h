// SPDX-License-Identifier: Apache-2.0
// Which depth frames are visible around the present moment: the one place where a SurfaceWindow's frames are chosen.
#pragma once

#include <span>
#include <vector>

#include "app/depth_window/shots.h"
#include "app/depth_window/surface_window.h"
#include "hal/media/media_time.h"

namespace relievo {

// Holds the present frame (the newest that is not later than now), the two before it and up to four after it, in
// ascending order of time, with their shots marked. Allocates; not for the real-time thread.
class WindowFrames {
 public:
  // Forgets all frames, and the shots with them.
  void clear() noexcept;
  // Makes `now` the present moment and drops the frames that have left the window. True if there were any.
  bool moveTo(MediaTime now);
  // Inserts a frame by its time; frames may come in any order. False if it was not inserted: another frame has its
  // time, or it lies before or beyond the window.
  bool add(TimedSurface frame);

  // True if four frames lie after the present moment: one more would be dropped at once.
  [[nodiscard]] bool full() const noexcept { return ahead() == SurfaceWindow::kAhead; }
  [[nodiscard]] bool contains(MediaTime time) const noexcept;
  [[nodiscard]] std::span<const TimedSurface> frames() const noexcept { return frames_; }
  // The present frame, or the first one when all lie ahead; null when there is none.
  [[nodiscard]] const TimedSurface* at(MediaTime now) const noexcept;

  // Copies the frames into `window`, in place of those that it held.
  void fill(SurfaceWindow& window) const;

 private:
  [[nodiscard]] int ahead() const noexcept;
  bool trim();

  std::vector<TimedSurface> frames_;
  ShotFinder shots_;
  MediaTime now_ = MediaTime::min();
};

}  // namespace relievo
