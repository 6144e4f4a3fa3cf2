// SPDX-License-Identifier: Apache-2.0
// What the player tells: on the screen, in the terminal, to programs and in the report.
#include <glm/geometric.hpp>
#include <utility>

#include "app/player/player.h"

namespace relievo {
namespace {

// The last part of a path or URL, without a query.
std::string titleOf(const std::string& url) {
  const std::string path = url.substr(0, url.find('?'));
  const std::size_t end = path.find_last_not_of('/');
  if (end == std::string::npos) return url;
  const std::size_t slash = path.rfind('/', end);
  const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  return path.substr(begin, end + 1 - begin);
}

std::optional<double> secondsOf(std::optional<MediaTime> time) {
  return time ? std::optional(toSeconds(*time)) : std::nullopt;
}

}  // namespace

void Player::tellStatus(MonotonicTime now) {
  if (parts_.status == nullptr || !parts_.status->isDue(now) || !film_.isOpen()) return;
  const auto finger = touch_.mark();
  parts_.status->show(facts(), report(), finger ? glm::length(finger->force_n) : 0, now);
}

// The report is long: it is made once a second, and only to be seen.
void Player::followStatistics(MonotonicTime now) {
  if (!screen_.wantsStatistics() || !statistics_.isDue(now)) return;
  const auto& finger = screen_.finger();
  screen_.setStatistics(statistics_.rows(report(), finger ? glm::length(finger->force_n) : 0.0, now));
}

PlayReport Player::report() const {
  PlayReport report = journal_.written();
  report.wall_s = journal_.sinceBegin(ended_.value_or(parts_.clock.now()));
  report.source = config_.source.url;
  report.depth_source = config_.source.depth_url;
  report.pairs = film_.pairs();
  report.media_s = toSeconds(film_.played());
  report.live = film_.live();
  report.reliefs = film_.reliefs();
  report.sound = film_.sound();
  report.seeks = seeks_.entries();
  report.volume = touch_.volume();
  report.haptic = touch_.summary();
  screen_.describe(report);
  const auto msSinceBegin = [this](std::optional<MonotonicTime> time) {
    return time ? std::optional(1e3 * journal_.sinceBegin(*time)) : std::nullopt;
  };
  report.first_frame_ms = msSinceBegin(screen_.firstShown());
  report.first_touch_ms = msSinceBegin(touch_.firstTick());
  return report;
}

ScreenFacts Player::facts() const {
  const PlaylistEntry& film = programme_.film();
  const auto& finger = screen_.finger();
  const DisplayVolume& volume = screen_.volume();
  const auto share = [&](double mm, double whole_mm) {
    return finger && whole_mm > 0 ? std::optional(mm / whole_mm) : std::nullopt;
  };
  const MediaTime position = film_.place(parts_.clock.now()).value_or(film_.picture().color.pts);
  return {.title = film.title.empty() ? titleOf(film.url) : film.title,
          .position_s = toSeconds(position),
          .duration_s = toSeconds(film_.info().duration),
          .buffered_s = toSeconds(film_.bufferedUntil()),
          .state = state_,
          .held = film_.held(),
          .rate = film_.rate(),
          .loop = programme_.loops(),
          .film = programme_.present() + 1,
          .films = programme_.size(),
          .stereo = screen_.stereo(),
          .has_depth = film_.info().has_depth,
          .haptic = touch_.device(),
          .contact = finger && finger->contact,
          .force_n = finger ? glm::length(finger->force_n) : 0.0,
          .volume_percent = loudness_.percent(),
          .muted = loudness_.muted(),
          .sound_track = describeTrack(film_.info().sounds, film_.info().sound),
          .subtitle_track = describeTrack(film_.info().subtitles, words_shown_ ? film_.info().words : std::nullopt),
          .sound_delay_s = toSeconds(film_.soundDelay()),
          .subtitle_delay_s = toSeconds(subtitle_delay_),
          .subtitle_size = screen_.subtitleSize(),
          .aspect = screen_.aspectWord(),
          .full_screen = screen_.isFullScreen(),
          .loop_from_s = secondsOf(loop_from_),
          .loop_to_s = secondsOf(loop_to_),
          .finger_across = share(finger ? finger->position_mm.x : 0.0, volume.width_mm),
          .finger_up = share(finger ? finger->position_mm.y : 0.0, volume.height_mm)};
}

}  // namespace relievo
