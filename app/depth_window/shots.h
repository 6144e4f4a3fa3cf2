// SPDX-License-Identifier: Apache-2.0
// Finds cuts and repeated frames in the depth of a film, ahead of playback.
#pragma once

#include <array>
#include <cstddef>
#include <map>

#include "app/depth_window/surface_window.h"
#include "hal/media/media_time.h"

namespace relievo {

// Examines 192 places of the picture, whatever its size. A place votes for a cut between two frames if its height jumps
// by more than 2 mm and by more than three times its motion in the frame before and the frame after: a fast rise shows
// in both of those, a cut in neither. A quarter of the readable places decides. A pair whose next frame has not arrived
// is judged without it, and again once it is there. After that the verdict is final; otherwise a rise would turn into a
// cut when the frame that showed its motion is dropped.
// A frame repeats the one before it if all samples are equal; the whole picture is compared only if the places are
// equal.
// For the feeder's thread, not the real-time one.
class ShotFinder {
 public:
  void forget() { seen_.clear(); }

  // Numbers the shots of frames in ascending order of time and marks repetitions. The first frame keeps its number.
  template <class Frames>  // of TimedSurface: random access
  void mark(Frames& frames) {
    if (frames.empty()) return;
    for (const TimedSurface& f : frames) look(f);
    seen_.erase(seen_.begin(), seen_.lower_bound(frames[0].time));
    for (std::size_t i = 1; i < frames.size(); ++i) {
      // A frame before the previous cut says nothing about the motion in this shot.
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
    MediaTime last;  // the frame before it at the time of the judgement
    bool repeats = false;
    MediaTime compared = MediaTime::min();  // the frame it was compared with
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
