// SPDX-License-Identifier: Apache-2.0
// Keeps a few depth pictures on both sides of the present one, since a cut is judged from its surroundings.
#include "app/player/film/coming_relief.h"

#include <algorithm>

namespace relievo {

void ComingRelief::forget() {
  seen_.clear();
  pictures_.clear();
  shots_.forget();
  present_ = 0;
  more_ = true;
}

bool ComingRelief::add(const Frame& depth, const DepthCalibration& calibration, const DisplayVolume& volume) {
  if (!seen_.empty() && seen_.back().time >= depth.pts) return true;
  const auto field = HeightField::make(depth, calibration, volume);
  if (!field) return false;
  Seen seen;
  seen.field = *field, seen.time = depth.pts, seen.owner = depth.owner;
  seen.coarse = CoarseRelief::of(*field);
  seen_.push_back(std::move(seen));
  return true;
}

bool ComingRelief::follow(const Frame& present, const DepthComing& coming, const DepthCalibration& calibration,
                          const DisplayVolume& volume) {
  const auto timeOf = [](const Seen& seen) { return seen.time; };
  const bool goes_back = !seen_.empty() && present.pts < seen_[std::min(present_, seen_.size() - 1)].time;
  if (goes_back) forget();
  if (!add(present, calibration, volume)) return true;
  const auto at = std::ranges::lower_bound(seen_, present.pts, {}, timeOf);
  if (at == seen_.end() || at->time != present.pts) {  // it was passed over when it came
    forget();
    if (!add(present, calibration, volume)) return true;
  }
  const auto place = std::ranges::lower_bound(seen_, present.pts, {}, timeOf) - seen_.begin();
  present_ = static_cast<std::size_t>(place);
  for (; present_ > kBefore; --present_) seen_.pop_front();
  for (std::size_t i = 0; i < coming.count; ++i) {
    if (!coming.frames[i].empty() && !add(coming.frames[i], calibration, volume)) break;
  }
  shots_.mark(seen_);
  more_ = !coming.last;
  pictures_.clear();
  for (std::size_t i = present_ + 1; i < seen_.size(); ++i) {
    const auto is = [&](const Frame& frame) { return !frame.empty() && frame.pts == seen_[i].time; };
    const auto found = std::find_if(coming.frames.begin(), coming.frames.begin() + coming.count, is);
    pictures_.push_back(static_cast<int>(found - coming.frames.begin()) + 1);
  }
  return present_ > 0 && seen_[present_].shot != seen_[present_ - 1].shot;
}

ReliefAhead ComingRelief::ahead() const noexcept {
  ReliefAhead ahead{.more = more_};
  for (std::size_t i = present_ + 1; i < seen_.size() && ahead.count < ReliefAhead::kMost; ++i) {
    if (seen_[i].shot != seen_[present_].shot) {
      ahead.more = false;
      break;
    }
    ahead.coming[ahead.count++] = {pictures_[i - present_ - 1], &seen_[i].coarse};
  }
  return ahead;
}

}  // namespace relievo
