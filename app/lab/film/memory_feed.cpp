// SPDX-License-Identifier: Apache-2.0
// Offers the window the frames around the present moment that can be had.
#include "app/lab/film/memory_feed.h"

#include <algorithm>

namespace relievo {

bool MemoryFeed::addFrames(MediaTime now, double machine_s) {
  const auto had = [&](auto frame) {
    return !supply_ || supply_(static_cast<std::size_t>(frame - film_.begin()), machine_s);
  };
  auto frame = std::ranges::upper_bound(film_, now, {}, &TimedSurface::time);
  for (int over = 0; frame != film_.begin() && over <= SurfaceWindow::kBefore;) over += had(--frame) ? 1 : 0;
  bool added = false;
  for (int ahead = 0; frame != film_.end() && ahead < SurfaceWindow::kAhead; ++frame) {
    if (!had(frame)) continue;
    if (!frames_.contains(frame->time)) added = frames_.add(*frame) || added;
    if (frame->time > now) ++ahead;
  }
  return added;
}

bool MemoryFeed::update(MediaTime now, double machine_s, std::uint32_t epoch, SurfaceWindow& window) {
  bool changed = std::exchange(first_, false) || epoch != std::exchange(epoch_, epoch);
  if (changed) frames_.clear();
  changed = frames_.moveTo(now) || changed;
  changed = addFrames(now, machine_s) || changed;
  if (!changed) return false;
  frames_.fill(window);
  window.clock = {};
  window.epoch = epoch;
  window.ended = !frames_.frames().empty() && frames_.frames().back().time == film_.back().time;
  return true;
}

}  // namespace relievo
