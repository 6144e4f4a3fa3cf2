// SPDX-License-Identifier: Apache-2.0
// The arrivals of a film's pairs, and the ages of its pictures.
#include "app/player/film/live_pace.h"

#include <algorithm>
#include <utility>

#include "app/media/playhead.h"

namespace relievo {

void LivePace::hear(const FramePair& pair) noexcept {
  if (!pair.taken || (newest_ && pair.color.pts <= *newest_)) return;
  newest_ = pair.color.pts;
  origin_ = *pair.taken - pair.color.pts.time_since_epoch();
  arrivals_.add(pair.color.pts, pair.delay);
  // Delays caused by the film's own start are not counted either.
  constexpr int kStart = 15;
  if (as_it_comes_ && ++since_choice_ == kStart) arrivals_.forgetAllBut(2);
}

bool LivePace::settled() const noexcept {
  constexpr std::size_t kFewest = Playhead::kAhead, kMost = 64;  // a decoder that never keeps pace is not waited for
  if (arrivals_.count() < kFewest) return false;
  return arrivals_.count() >= kMost || arrivals_.keepsPace() || arrivals_.newest() <= arrivals_.period();
}

// What arrived while the source was opened shows nothing of its jitter.
bool LivePace::choose() noexcept {
  if (as_it_comes_) return *as_it_comes_;
  as_it_comes_ = arrivals_.soonest() >= Duration(0);
  ahead_ = lookAheadFor(arrivals_.period(), kLeastLate);
  arrivals_.forgetAllBut(2);
  return *as_it_comes_;
}

void LivePace::shown(Duration age) noexcept {
  shown_[shown_count_++ % kShown] = age;
}

Duration LivePace::age() const noexcept {
  constexpr std::size_t kShort = 30;
  Duration age = arrivals_.age(ahead_);
  if (arrivals_.count() < kShort) {
    age = std::max(age, ahead_.frames * arrivals_.period() - ahead_.carried + kLeastLate + Arrivals::kMargin);
  }
  if (shown_count_ < kShown) return age;
  // The oldest of many is an outlier.
  auto ages = shown_;
  std::nth_element(ages.begin(), ages.end() - 2, ages.end());
  return std::max(age, *(ages.end() - 2) - kMostBefore);
}

MediaTime LivePace::wanted(MonotonicTime now) const noexcept {
  return MediaTime(now - origin_ - age());
}

MonotonicTime LivePace::next() const noexcept {
  return origin_ + newest_.value_or(MediaTime{}).time_since_epoch() + arrivals_.period() + arrivals_.soonest();
}

}  // namespace relievo
