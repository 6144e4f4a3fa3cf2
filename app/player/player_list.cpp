// SPDX-License-Identifier: Apache-2.0
// What the player does from film to film: opens, leaves, ends, and skips what cannot be played.
#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "app/player/player.h"
#include "platform/log.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

constexpr Error kNoPicture{ErrorCode::Corrupt, 0,
                           "it ended without a single picture; check that its files are still there and whole"};

bool isSubtitles(const std::string& url) {
  constexpr std::array kEndings{".srt", ".ass", ".ssa", ".vtt"};
  return std::ranges::find(kEndings, lowerCase(std::filesystem::path(url).extension().string())) != kEndings.end();
}

}  // namespace

void Player::openList(const std::vector<PlaylistEntry>& films, MonotonicTime now, std::vector<std::string> words) {
  if (!nextState(state_, PlayerEvent::Open)) return;
  leaveFilm(now);
  words_to_add_ = std::move(words);
  programme_.begin(films);
  openFilm(0, Programme::Way::Forward, now);
}

// Films dropped on the window are played instead of the present one. Subtitles are shown with the film that is dropped
// with them, else with the present one.
void Player::followDrops(MonotonicTime now) {
  std::vector<PlaylistEntry> films;
  std::vector<std::string> words;
  std::vector<std::string> dropped = screen_.takeDropped();
  const bool film = film_.isOpen() || !std::ranges::all_of(dropped, isSubtitles);
  for (std::string& url : dropped) {
    if (film && isSubtitles(url)) words.push_back(std::move(url));
    else films.push_back({.url = std::move(url), .depth_url = "", .title = ""});
  }
  if (!films.empty()) return openList(films, now, std::move(words));
  for (const std::string& path : words) addWords(path, now);
}

void Player::openFilm(std::size_t film, Programme::Way way, MonotonicTime now) {
  if (!apply(PlayerEvent::Open)) return;
  closeBrowser();
  leaveFilm(now);
  programme_.choose(film, way);
  const PlaylistEntry& entry = programme_.film();
  journal_.filmAsked(entry.url, entry.depth_url);
  if (entry.refused) return;  // followOpening fails it like a film that cannot be opened
  SourceOptions source = config_.source;
  source.url = entry.url;
  source.depth_url = entry.depth_url;
  film_.open(std::move(source));
}

// Sets the force to zero first; then closes the film and forgets its state.
void Player::leaveFilm(MonotonicTime now) {
  if (!film_.isOpen()) return;
  if (film_.opening() != FilmPlayback::Opening::IsList) {  // a list's are those of its film
    config_.start.reset();
    words_to_add_.clear();
  }
  touch_.rest();
  programme_.keepAtOnce(film_.placeToKeep(now), now);
  programme_.left(film_.begun());
  seeks_.forget();
  screen_.subtitles().forget();
  for (const std::string& doubt : doubts_.end()) screen_.text().forgetWarning(doubt);
  film_.close(now);
}

void Player::stopFilm(MonotonicTime now) {
  if (!nextState(state_, PlayerEvent::Stop)) return;
  const bool had_film = state_ != PlayerState::Browsing;
  leaveFilm(now);
  closeBrowser();
  apply(PlayerEvent::Stop);
  if (had_film && returnsToBrowser()) return openBrowser(now);
  if (config_.stays) screen_.clear();
}

void Player::endFilm(MonotonicTime now) {
  if (film_.gaveNone(now)) return failFilm(programme_.film().url, kNoPicture);
  film_.countPlayed(now);
  const std::vector<LostPart> lost = film_.noteMissing();
  if (!lost.empty() && endsWithFilms() && !missed_) missed_ = failureOf(lost.front());
  apply(PlayerEvent::EndOfFilm);
  programme_.forgetPlace();
  const auto next = programme_.afterEnd();
  if (next == programme_.present() && !film_.refusesSeeks()) return seek(MediaTime{}, PlayerEvent::Loop, false, now);
  film_.forgetPlace();
  if (next) return openFilm(*next, Programme::Way::Forward, now);
  stopFilm(now);
}

// Opens another film of the list after one that failed. The run ends with the first failure; the log names the others.
// Where the viewer can choose another film, none of them counts.
void Player::followFault(MonotonicTime now) {
  if (state_ != PlayerState::Fault || display_failed_) return;
  const auto other = programme_.afterFault();
  if (!other && config_.faults_in_list) browsed_ = true;
  const bool counts = endsWithFilms();
  const bool first = counts && !missed_;
  if (first) missed_ = failure_;
  if (first && !other) return;
  const std::string what = failure_->thing + ": " + failure_->error.message;
  log(LogLevel::Error, "play", "%s; %s", what.c_str(), other ? "another film is played" : "it is stopped");
  if (other) {
    screen_.text().tell(what, now);
    return openFilm(*other, programme_.passOver(*other), now);
  }
  if (counts) return;
  failure_.reset();
  stopFilm(now);
  screen_.text().tell(what, now);
}

}  // namespace relievo
