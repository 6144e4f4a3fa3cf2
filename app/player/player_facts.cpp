// SPDX-License-Identifier: Apache-2.0
// The player's output: on the screen, in the terminal, to programs and in the report.
#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <utility>

#include "app/media/playlist.h"
#include "app/player/player.h"
#include "platform/print.h"

namespace relievo {
namespace {

FingerForces forcesOf(const FingerMarks& marks) {
  const auto force = [](const std::optional<FingerMark>& mark) { return mark ? glm::length(mark->force_n) : 0.0; };
  return {force(marks[0]), force(marks[1])};
}

FingerFacts fingerFacts(std::string device, const std::optional<FingerMark>& mark, const DisplayVolume& volume) {
  FingerFacts facts{.haptic = std::move(device)};
  if (!mark) return facts;
  facts.contact = mark->contact;
  facts.force_n = glm::length(mark->force_n);
  if (volume.width_mm > 0) facts.across = mark->position_mm.x / volume.width_mm;
  if (volume.height_mm > 0) facts.up = mark->position_mm.y / volume.height_mm;
  return facts;
}

std::string chapterWords(const std::vector<Chapter>& chapters, MediaTime here) {
  if (chapters.empty()) return "";
  const auto after = std::ranges::upper_bound(chapters, here, {}, [](const Chapter& c) { return MediaTime(c.begin); });
  const auto number = std::max<std::ptrdiff_t>(after - chapters.begin(), 1);
  const std::string& title = chapters[static_cast<std::size_t>(number) - 1].title;
  return print("%td of %zu", number, chapters.size()) + (title.empty() ? "" : ", " + title);
}

std::optional<double> secondsOf(std::optional<MediaTime> time) {
  return time ? std::optional(toSeconds(*time)) : std::nullopt;
}

}  // namespace

// The last part of the film's path or URL.
std::string Player::fileName() const {
  const std::string& url = programme_.film().url;
  const std::string path(withoutQuery(url));
  const std::size_t end = path.find_last_not_of('/');
  if (end == std::string::npos) return url;
  const std::size_t slash = path.rfind('/', end);
  const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  return path.substr(begin, end + 1 - begin);
}

void Player::tellStatus(MonotonicTime now) {
  if (parts_.status == nullptr || !parts_.status->isDue(now) || !film_.isOpen()) return;
  parts_.status->show(facts(), report(), forcesOf(touch_.marks()), screen_.text().noticed(now), now);
}

// The report is long: it is made once a second, and only while it is shown.
void Player::followStatistics(MonotonicTime now) {
  if (!screen_.wantsStatistics() || !statistics_.isDue(now)) return;
  screen_.setStatistics(statistics_.rows(report(), forcesOf(screen_.fingers()), now));
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
  report.haptic = touch_.fingers()[0].session().summary();
  screen_.describe(report);
  const auto msSinceBegin = [this](std::optional<MonotonicTime> time) {
    return time ? std::optional(1e3 * journal_.sinceBegin(*time)) : std::nullopt;
  };
  report.first_frame_ms = msSinceBegin(screen_.firstShown());
  report.first_touch_ms = msSinceBegin(touch_.fingers()[0].firstTick());
  if (touch_.fingers().size() > 1) {
    const Finger& second = touch_.fingers()[1];
    report.second_finger = {second.session().summary(), msSinceBegin(second.firstTick())};
  }
  return report;
}

// For whoever has a mouse alone: what has a meaning for this film.
std::vector<PlayerVerb> Player::barButtons() const {
  if (!config_.has_mouse || !film_.isOpen()) return {};
  const FilmInfo& info = film_.info();
  const bool has_3d = info.has_depth || !film_.picture().right.empty();
  std::vector<PlayerVerb> buttons{PlayerVerb::PlayPause};
  const auto add = [&buttons](PlayerVerb verb, bool has_meaning) {
    if (has_meaning) buttons.push_back(verb);
  };
  add(PlayerVerb::Next, !refusal({PlayerVerb::Next}));
  add(PlayerVerb::SubtitleTrack, !info.subtitles.empty());
  add(PlayerVerb::AudioTrack, info.sounds.size() > 1);
  add(PlayerVerb::Layout, has_3d);
  add(PlayerVerb::FullScreen, true);
  add(PlayerVerb::Back, returnsToBrowser());
  add(PlayerVerb::Keys, true);
  return buttons;
}

ScreenFacts Player::facts() const {
  const PlaylistEntry& film = programme_.film();
  std::array<FingerFacts, 2> fingers;
  for (std::size_t i = 0; i < touch_.fingers().size(); ++i) {
    fingers[i] = fingerFacts(touch_.fingers()[i].device(), screen_.fingers()[i], screen_.volume());
  }
  const auto shelf_place = placeOnShelf();
  const auto place = shelf_place ? browser_->shelf().placeInSection(*shelf_place)
                                 : FilmShelf::Place{programme_.present() + 1, programme_.size()};
  const MediaTime position = film_.place(parts_.clock.now()).value_or(film_.picture().color.pts);
  const std::string& title = film_.info().title.empty() ? film.title : film_.info().title;
  return {.title = title.empty() ? fileName() : title,
          .position_s = toSeconds(position),
          .duration_s = toSeconds(film_.info().duration),
          .buffered_s = toSeconds(film_.bufferedUntil()),
          .state = state_,
          .held = film_.held(),
          .rate = film_.rate(),
          .loop = programme_.loops(),
          .film = place.number,
          .films = place.of,
          .stereo = screen_.stereo(),
          .has_depth = film_.info().has_depth,
          .fingers = fingers,
          .volume_percent = loudness_.percent(),
          .muted = loudness_.muted(),
          .sound_track = describeTrack(film_.info().sounds, film_.info().sound),
          .subtitle_track = describeTrack(film_.info().subtitles, words_shown_ ? film_.info().words : std::nullopt),
          .sound_delay_s = toSeconds(film_.soundDelay()),
          .subtitle_delay_s = toSeconds(screen_.subtitles().delay()),
          .subtitle_size = screen_.subtitles().size(),
          .chapter = chapterWords(film_.info().chapters, film_.goal(parts_.clock.now())),
          .aspect = screen_.aspectWord(),
          .turned_degrees = 90 * film_.turns(),
          .full_screen = screen_.isFullScreen(),
          .buttons = barButtons(),
          .loop_from_s = secondsOf(loop_ab_.from()),
          .loop_to_s = secondsOf(loop_ab_.to())};
}

}  // namespace relievo
