// SPDX-License-Identifier: Apache-2.0
// The measurement waits for the picture, then for the touch.
#include "app/player/film/seek_times.h"

namespace relievo {

void SeekTimes::asked(MediaTime target, bool by_viewer, MonotonicTime now) {
  const bool measured = by_viewer && entries_.size() < kMost;
  waits_ = measured ? Waits::Picture : Waits::Nothing;
  asked_ = now;
  if (measured) entries_.push_back({toSeconds(target), {}, {}, {}, {}});
}

void SeekTimes::shown(MediaTime picture, MonotonicTime now, MonotonicTime touch_from) {
  if (waits_ != Waits::Picture) return;
  entries_.back().picture_s = toSeconds(picture);
  entries_.back().picture_ms = 1e3 * toSeconds(now - asked_);
  touch_from_ = touch_from;
  waits_ = Waits::Touch;
}

void SeekTimes::felt(MonotonicTime tick, std::optional<MediaTime> frame) {
  if (!waitsForTouch(tick)) return;
  if (frame) entries_.back().surface_s = toSeconds(*frame);
  entries_.back().surface_ms = 1e3 * toSeconds(tick - asked_);
  waits_ = Waits::Nothing;
}

}  // namespace relievo
