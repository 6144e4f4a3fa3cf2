// SPDX-License-Identifier: Apache-2.0
// Converts commands to actions.
#include "app/player/control/wishes.h"

#include <algorithm>
#include <array>
#include <utility>

namespace relievo {
namespace {

constexpr std::array kRates{0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0};
constexpr Duration kBeginning = std::chrono::seconds(3);  // up to here "previous" goes to the previous film

using Deeds = std::vector<Deed>;

// The next rate up (1) or down (-1) the ladder.
double rateBeside(double rate, int step) noexcept {
  const auto at = std::ranges::find(kRates, rate) - kRates.begin();
  return kRates[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at + step, 0, kRates.size() - 1))];
}

Deed seek(MediaTime target, bool by_viewer) {
  return {.kind = Deed::Kind::Seek, .target = target, .by_viewer = by_viewer};
}

Deed open(std::size_t film, bool back = false) {
  return {.kind = Deed::Kind::OpenFilm, .film = film, .back = back};
}

// Entering and leaving key-frame playback needs a seek to the present position.
Deeds changeRate(double rate, const Situation& s) {
  if (rate == s.rate || !nextState(s.state, PlayerEvent::Rate)) return {};
  if (rate > 1 && s.length <= Duration(0)) return {};
  Deeds deeds{{.kind = Deed::Kind::Rate, .rate = rate}};
  if (rate > 1 || s.rate > 1) deeds.push_back(seek(s.here, false));
  return deeds;
}

// While a film is being opened, buffered or sought, the command takes effect from the next picture on.
Deeds goOnAt(double rate, Situation s) {
  if (s.state == PlayerState::Idle) return s.film_asked ? Deeds{open(s.film)} : Deeds{};
  Deeds deeds{{.kind = Deed::Kind::GoOn}};
  s.state = nextState(s.state, PlayerEvent::Play).value_or(s.state);
  for (const Deed& deed : changeRate(rate, s)) deeds.push_back(deed);
  return deeds;
}

Deeds pause(const Situation& s) {
  Deeds deeds = s.rate > 1 ? changeRate(1, s) : Deeds{};  // so that the paused picture can be touched
  deeds.push_back({.kind = Deed::Kind::Stand});
  return deeds;
}

// Slow motion goes on as it was paused.
Deeds playOrPause(const Situation& s) {
  if (s.held || s.state == PlayerState::Idle) return goOnAt(std::min(s.rate, 1.0), s);
  return s.rate > 1 ? goOnAt(1, s) : pause(s);
}

// A rate over 1 shows key frames only, and not while paused: a paused film goes on.
Deeds faster(const Situation& s) {
  const double rate = rateBeside(s.rate, 1);
  return s.held && rate > 1 && s.length > Duration(0) ? goOnAt(rate, s) : changeRate(rate, s);
}

// A seek shows the first picture at or after its target, or the one that stands there for long.
Deeds stepBack(const Situation& s) {
  if (s.rate > 1) return pause(s);
  if (!nextState(s.state, PlayerEvent::Step)) return {};
  return {{.kind = Deed::Kind::Stand}, seek(s.picture - s.period * 3 / 2, false)};
}

Deeds seekShare(double share, const Situation& s) {
  if (s.length <= Duration(0)) return {};
  return {seek(mediaTime(share * toSeconds(s.length)), true)};
}

Deeds previous(const Situation& s) {
  if (s.here < MediaTime(kBeginning) && s.film > 0) return {open(s.film - 1, true)};
  return {seek(MediaTime{}, true)};
}

MediaTime beginOf(const Chapter& chapter) {
  return std::max(MediaTime(chapter.begin), MediaTime{});
}

// Goes back to this chapter's beginning, or from near that to the one before. There is nothing after the last chapter.
Deeds seekChapter(int by, const Situation& s) {
  if (s.chapters.empty()) return {};
  const MediaTime from = by < 0 ? s.here - kBeginning : s.here;
  const auto next = std::ranges::upper_bound(s.chapters, from, {}, beginOf);
  const auto wished = (next - s.chapters.begin()) + (by > 0 ? by - 1 : by);
  if (wished >= std::ssize(s.chapters)) return {};
  return {seek(beginOf(s.chapters[static_cast<std::size_t>(std::max<std::ptrdiff_t>(wished, 0))]), true)};
}

}  // namespace

std::vector<Deed> deedsFor(const PlayerCommand& command, const Situation& s) {
  switch (command.verb) {
    case PlayerVerb::Play:
      return goOnAt(1, s);
    case PlayerVerb::Pause:
      return pause(s);
    case PlayerVerb::PlayPause:
      return playOrPause(s);
    case PlayerVerb::Step:
      return s.rate > 1 ? pause(s) : Deeds{{.kind = Deed::Kind::StepOn}};
    case PlayerVerb::StepBack:
      return stepBack(s);
    case PlayerVerb::NormalSpeed:
      return changeRate(1, s);
    case PlayerVerb::Faster:
      return faster(s);
    case PlayerVerb::Slower:
      return changeRate(rateBeside(s.rate, -1), s);
    case PlayerVerb::SeekBy:
      return {seek(s.here + fromSeconds(command.value), true)};
    case PlayerVerb::SeekTo:
      return {seek(mediaTime(command.value), true)};
    case PlayerVerb::SeekShare:
      return seekShare(command.value, s);
    case PlayerVerb::ChapterBy:
      return seekChapter(static_cast<int>(command.value), s);
    case PlayerVerb::Next:
      if (s.film + 1 < s.films) return {open(s.film + 1)};
      return s.wraps ? Deeds{open(0)} : Deeds{};
    case PlayerVerb::Previous:
      return previous(s);
    default:
      return {};
  }
}

}  // namespace relievo
