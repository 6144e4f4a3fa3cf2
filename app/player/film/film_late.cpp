// SPDX-License-Identifier: Apache-2.0
// A film whose next picture is not there in time: what is left out where this machine is too slow to decode it, when
// the picture stops for its source, and how late one is.
#include "app/player/film/film_playback.h"

#include <algorithm>

namespace relievo {
namespace {

constexpr Duration kAfterHurry = std::chrono::milliseconds(300);  // how much of the film a hurry gains on the clock

constexpr Duration kStillStands = std::chrono::seconds(5);
constexpr Duration kLivePatience = std::chrono::milliseconds(100);  // nothing is behind a live film's newest picture

}  // namespace

// A pair that is less than a period late is shown late; after that the film waits for its source. The delay counts from
// the moment when the pair was missed, not from the last picture, which may have taken long to draw.
FilmPlayback::Progress FilmPlayback::going(MonotonicTime now) {
  if (!head_.ahead().empty()) {
    dry_since_.reset();
    return Progress::Goes;
  }
  if (head_.last()) {
    const MediaTime position = clock_.position(now).value_or(MediaTime{});
    MediaTime end = picture().color.pts + (isStill() ? kStillStands : period());
    if (rushes()) end = std::max(end, MediaTime(info_.duration));  // the last key frame stands for what follows it
    const bool shown = position >= end;
    const bool sounds = rate_ == 1 && sound_.end() > position;  // longer than the picture
    return shown && !sounds ? overOrFailed() : Progress::Goes;
  }
  if (!dry_since_) dry_since_ = now;
  const Duration patience = isLive() ? 4 * period() + kLivePatience : 2 * period();
  // If the decoder is too slow, stopping would not help: it leaves out pictures until it is in time.
  if (now < *dry_since_ + patience || waitsForDecoder()) return Progress::Goes;
  dry_since_.reset();
  starved_ = true;
  countPlayed(now);
  return Progress::Starved;
}

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
