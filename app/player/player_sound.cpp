// SPDX-License-Identifier: Apache-2.0
// What the player does with the film's sound and its words.
#include <algorithm>

#include "app/player/player.h"

namespace relievo {

// False for a command that is none of these.
bool Player::obeySound(const PlayerCommand& command, MonotonicTime now) {
  switch (command.verb) {
    case PlayerVerb::VolumeBy:
      setVolume(loudness_.percent() + command.value);
      return true;
    case PlayerVerb::VolumeTo:
      setVolume(command.value);
      return true;
    case PlayerVerb::Mute:
      mute(command.value == 0 ? !loudness_.muted() : command.value > 0);
      return true;
    case PlayerVerb::AudioTrack: {
      const std::size_t count = film_.info().sounds.size();
      if (count == 0) return true;
      std::size_t next = (film_.info().sound.value_or(count - 1) + 1) % count;
      if (command.value > 0) next = static_cast<std::size_t>(command.value) - 1;
      if (command.value == kPreviousTrack) next = (film_.info().sound.value_or(0) + count - 1) % count;
      chooseTracks(next, film_.info().words, now);
      return true;
    }
    case PlayerVerb::AudioDelayBy:
      film_.soundOutput().setDelay(film_.soundOutput().delay() + fromSeconds(command.value));
      return true;
    case PlayerVerb::SubtitleTrack:
      nextWords(command.value, now);
      return true;
    case PlayerVerb::ShowSubtitles:
      showWords(command.value == 0 ? !words_shown_ || !film_.info().words : command.value > 0, now);
      return true;
    case PlayerVerb::LoopAB:
      loop_ab_.mark(film_.place(now));
      return true;
    default:
      return false;
  }
}

void Player::setVolume(double percent) {
  loudness_.set(percent);
  mute(false);
}

void Player::mute(bool muted) {
  const bool changes = loudness_.muted() != muted;
  loudness_.mute(muted);
  film_.soundOutput().setGain(loudness_.gain(), changes);
}

// What was read ahead has the old tracks, so the film is read again from its present position; a live film is not.
void Player::chooseTracks(std::optional<std::size_t> sound, std::optional<std::size_t> words, MonotonicTime now) {
  const FilmInfo& info = film_.info();
  if (sound && *sound >= info.sounds.size()) return;
  if (words && *words >= info.subtitles.size()) return;
  if (sound == info.sound && words == info.words) return;
  if (words != info.words) screen_.subtitles().forget();
  film_.chooseTracks(sound, words);
  journal_.filmIs(film_.info());
  if (info.duration > Duration(0)) seek(film_.goal(now), PlayerEvent::Seek, false, now);
}

// A subtitle file that the viewer has dropped. The one that is shown is read again, since it may have been changed.
void Player::addWords(const std::string& path, MonotonicTime now) {
  if (refusal({PlayerVerb::SubtitleTrack})) return obey({PlayerVerb::SubtitleTrack}, now);  // it says why
  const auto& tracks = film_.info().subtitles;
  const auto known = std::ranges::find(tracks, path, &FilmTrack::path);
  const auto at = static_cast<std::size_t>(known - tracks.begin());
  const bool anew = known == tracks.end() || film_.info().words == at;
  const auto place = static_cast<double>(anew ? tracks.size() : at) + 1;
  if (anew) film_.addSubtitles({.path = path});
  obey({PlayerVerb::SubtitleTrack, place}, now);
}

// After the last track, and before the first, comes none. Where the present one is hidden, it is shown again.
void Player::nextWords(double number, MonotonicTime now) {
  const FilmInfo& info = film_.info();
  const std::size_t count = info.subtitles.size(), none = count;
  const bool back = number == kPreviousTrack;
  std::size_t next = none;
  if (number > static_cast<double>(count)) return;
  if (number > 0) next = static_cast<std::size_t>(number) - 1;
  else if ((number == 0 || back) && info.words && !words_shown_) next = *info.words;
  else if (number == 0 || back) next = (info.words.value_or(none) + (back ? count : 1)) % (count + 1);
  chooseTracks(info.sound, next == none ? std::nullopt : std::optional(next), now);
  words_shown_ = next != none;
  screen_.subtitles().show(words_shown_);
}

void Player::showWords(bool shown, MonotonicTime now) {
  if (shown && !film_.info().words) return nextWords(0, now);
  words_shown_ = shown;
  screen_.subtitles().show(shown);
}

// A film begins.
void Player::beginWords() {
  words_shown_ = film_.info().words.has_value();
  screen_.subtitles().show(words_shown_);
  loop_ab_.forget();
  std::vector<double> starts;
  for (const Chapter& chapter : film_.info().chapters) starts.push_back(toSeconds(chapter.begin));
  screen_.text().setChapters(std::move(starts));
}

void Player::followLoopAB(MonotonicTime now) {
  if (state_ != PlayerState::Playing) return;
  if (film_.refusesSeeks()) loop_ab_.forget();
  if (const auto begin = loop_ab_.backFrom(film_.place(now))) seek(*begin, PlayerEvent::Seek, false, now);
}

}  // namespace relievo
