// SPDX-License-Identifier: Apache-2.0
// A film that this machine cannot decode in time: which pictures are left out, and what is reported; how late one is.
#include "app/player/film/film_playback.h"

namespace relievo {
namespace {

constexpr Duration kAfterHurry = std::chrono::milliseconds(300);  // how much of the film a hurry gains on the clock

}  // namespace

void FilmPlayback::followDecoder(MonotonicTime now) {
  const auto position = clock_.position(now);
  if (!own_threads_ || held_ || rushes() || !position) return decode_pace_.pause();
  const FilmFeed::Effort effort = feed_.effort();
  const bool dry = head_.ahead().empty() && !head_.last();
  const bool left_out = decode_pace_.leavesOut();
  decode_pace_.look({.filled = head_.filled() || head_.last(),
                     .rested = effort.rested,
                     .decodes = effort.decodes,
                     .late = dry ? *position - (picture().color.pts + period()) : Duration(0)},
                    now);
  const bool leaves_out = decode_pace_.leavesOut(), hurry = decode_pace_.takeHurry();
  if (leaves_out == left_out && !hurry) return;
  feed_.leaveOut(leaves_out, hurry ? std::optional(*position + kAfterHurry) : std::nullopt);
  if (leaves_out) notes_.slow();
}

std::optional<Duration> FilmPlayback::late(MonotonicTime now) const {
  const auto position = clock_.position(now);
  return position && !isLive() ? std::optional(*position - picture().color.pts) : std::nullopt;
}

bool FilmPlayback::waitsForDecoder() const noexcept {
  return own_threads_ && !held_ && !rushes() && !isLive() && !decode_pace_.waitsForSource();
}

}  // namespace relievo
