// SPDX-License-Identifier: Apache-2.0
// A live film: its pictures are shown as they arrive, and its clock follows touch (LivePace).
#include "app/player/film/film_playback.h"

namespace relievo {
namespace {

constexpr Duration kOutOfPace = std::chrono::milliseconds(250);  // a live film that is so far off jumps

}  // namespace

void FilmPlayback::hearOfAhead() noexcept {
  for (const FramePair& pair : head_.ahead()) pace_.hear(pair);
}

// Keeps the last few pictures for the plan; the film starts with the newest of them.
FilmPlayback::Progress FilmPlayback::fillingLive() {
  for (hearOfAhead(); head_.filled() && !pace_.settled(); hearOfAhead()) {
    head_.skip();
    head_.refill(feed_);
  }
  if (head_.last()) return head_.ahead().empty() ? overOrFailed() : Progress::Ready;
  if (!head_.filled()) return Progress::Goes;
  pace_.choose();
  return Progress::Ready;
}

std::size_t FilmPlayback::advanceLive(MonotonicTime now) {
  if (held_) return 0;
  head_.refill(feed_);
  hearOfAhead();
  const MediaTime felt = clock_.position(now).value_or(MediaTime{});
  const std::size_t pictures = head_.advance(felt + kMostBehind, feed_);
  followLive(pictures > 0, now);
  return pictures;
}

// Only once a picture, since every change of the clock is published.
void FilmPlayback::followLive(bool picture, MonotonicTime now) {
  const auto felt = clock_.position(now);
  if (!felt) return;
  const Duration behind = pace_.wanted(now) - *felt;
  if (std::chrono::abs(behind) > kOutOfPace) {
    clock_.start(pace_.wanted(now), now);
    live_.begin(pace_.origin(), now);
  }
  if (!picture) return;
  dry_since_.reset();
  static_cast<void>(clock_.setRate(rateToGain(behind), now));  // the clock accepts all rates of this size
}

// The surface under the finger is that of the clock's time.
void FilmPlayback::noteLiveShown() {
  const MonotonicTime now = clock_source_.now();
  const auto felt = clock_.position(now);
  if (!picture().taken || !felt) return;  // the film's first picture is shown before its clock runs
  const Duration age = now - *picture().taken;
  live_.shown(age, age - (*felt - picture().color.pts));
  if (isLive()) pace_.shown(age);
}

}  // namespace relievo
