// SPDX-License-Identifier: Apache-2.0
// Finds the cuts of a film in its depth, ahead of time, and where it stands still: whether a frame continues the one
// before it, and whether it only repeats it.
#pragma once

#include <array>
#include <cstddef>
#include <map>

#include "app/depth_window/surface_window.h"
#include "hal/media_time.h"

namespace relievo {

// Looks at 192 places of the picture, whatever its size. A place votes for a cut between two frames when its height
// jumps there by more than 2 mm and by more than three times what it moves in the frame before and the frame after: a
// fast rise moves in both, a cut in neither. A quarter of the places that can be read decide. A pair whose next frame
// is not there yet is judged without it, and again when it is; after that the verdict stands, or a rise would become a
// cut when the frame that showed its motion is let go.
// A frame repeats the one before it when all its samples are the same: where the places differ no more is looked at.
// The feeder's thread, not the real-time one.
class ShotFinder {
 public:
  void forget() { seen_.clear(); }

  // Numbers the shots of frames in ascending order of time and tells repetitions. The first frame keeps what it has.
  template <class Frames>  // of TimedSurface: random access
  void mark(Frames& frames) {
    if (frames.empty()) return;
    for (const TimedSurface& f : frames) look(f);
    seen_.erase(seen_.begin(), seen_.lower_bound(frames[0].time));
    for (std::size_t i = 1; i < frames.size(); ++i) {
      // A frame before the last cut says nothing about this shot's motion.
      const bool motion_before = i >= 2 && frames[i - 2].shot == frames[i - 1].shot;
      const TimedSurface* before = motion_before ? &frames[i - 2] : nullptr;
      const TimedSurface* after = i + 1 < frames.size() ? &frames[i + 1] : nullptr;
      frames[i].shot = frames[i - 1].shot + (beginsShot(before, frames[i - 1], frames[i], after) ? 1 : 0);
      frames[i].repeats = repeats(frames[i - 1], frames[i]);
    }
  }

 private:
  static constexpr int kAcross = 16, kDown = 12;
  using Places = std::array<double, static_cast<std::size_t>(kAcross) * kDown>;
  struct Seen {
    Places heights;  // mm
    bool cut = false, judged = false;
    MediaTime last;  // the frame before it when it was judged
    bool repeats = false;
    MediaTime compared = MediaTime::min();  // with which frame
  };
  void look(const TimedSurface& frame);
  [[nodiscard]] bool beginsShot(const TimedSurface* before, const TimedSurface& last, const TimedSurface& next,
                                const TimedSurface* after);
  [[nodiscard]] bool isCut(const TimedSurface* before, const TimedSurface& last, const TimedSurface& next,
                           const TimedSurface* after) const;
  [[nodiscard]] bool repeats(const TimedSurface& last, const TimedSurface& next);

  std::map<MediaTime, Seen> seen_;
};

}  // namespace relievo
