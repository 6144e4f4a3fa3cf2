// SPDX-License-Identifier: Apache-2.0
// From film to film: lists, beginnings, ends, and where one was left.
#include <algorithm>
#include <utility>

#include "app/player/player.h"
#include "app/player/text_line.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr Duration kBeginning = std::chrono::seconds(3);  // so near to it, "previous" means the film before
constexpr Duration kKeepPeriod = std::chrono::seconds(2);

}  // namespace

void Player::openList(const std::string& url, const std::string& depth_url, MonotonicTime now) {
  if (!nextState(state_, PlayerEvent::Open)) return;
  leaveFilm(now);
  films_ = {{.url = url, .depth_url = depth_url, .title = ""}};
  openFilm(0, now);
}

// The source has turned out to be a list.
void Player::followList(MonotonicTime now) {
  report_.films.pop_back();  // a list is no film
  films_ = feed_.films();
  std::size_t first = 0;
  if (const auto last = resume_ ? resume_->last() : std::nullopt) {
    const auto seen = std::ranges::find(films_, *last, &PlaylistEntry::url);
    if (seen != films_.end()) first = static_cast<std::size_t>(seen - films_.begin());
  }
  openFilm(first, now);
}

void Player::openFilm(std::size_t film, MonotonicTime now) {
  if (!apply(PlayerEvent::Open)) return;
  leaveFilm(now);
  film_ = film;
  SourceOptions source = config_.source;
  source.url = films_[film].url;
  source.depth_url = films_[film].depth_url;
  report_.films.push_back(source.url);
  feed_.open(std::move(source));
  film_open_ = true;
}

void Player::previousFilm(MonotonicTime now) {
  const bool at_beginning = seekBase(now) < MediaTime(kBeginning);
  if (at_beginning && film_ > 0) return openFilm(film_ - 1, now);
  seek(MediaTime{}, PlayerEvent::Seek, true, now);
}

// Force to zero first; then all that belongs to the film is forgotten.
void Player::leaveFilm(MonotonicTime now) {
  if (!std::exchange(film_open_, false)) return;
  haptic_.rest();
  keep_due_ = now;
  keepPosition(now);
  closeSegment(now);
  report_.pairs += feed_.counters();
  feed_.close();
  clock_.reset();
  static_cast<void>(clock_.setRate(rate_ = 1, now));
  head_ = {};
  sound_.forget();
  surface_.beginEpoch();
  held_ = scene_known_ = depth_missing_ = depth_refused_ = false;
  new_epoch_ = true;
  target_.reset();
  await_touch_.reset();
  dry_since_.reset();
}

void Player::stopFilm(MonotonicTime now) {
  if (!nextState(state_, PlayerEvent::Stop)) return;
  leaveFilm(now);
  apply(PlayerEvent::Stop);
  if (!config_.stays) return;
  picture_.clear();
  static_cast<void>(draw(now));
}

void Player::endOfFilm(MonotonicTime now) {
  closeSegment(now);
  noteMissing();
  apply(PlayerEvent::EndOfFilm);
  if (resume_) resume_->forget(film().url);
  const bool more = film_ + 1 < films_.size();
  const bool again = !more && config_.loop;
  if (again && films_.size() == 1) return seek(MediaTime{}, PlayerEvent::Loop, false, now);
  clock_.reset();  // where this film ended is not where one left it
  if (more) return openFilm(film_ + 1, now);
  if (!again) return stopFilm(now);
  openFilm(0, now);
}

void Player::noteMissing() {
  const auto noteOne = [this](const std::string& url, Duration missing, const char* done) {
    if (missing <= Duration(0)) return;
    note(textLine("%s breaks off %.1f s before its end, cut off or damaged", url.c_str(), toSeconds(missing)), done);
  };
  const PairCounters pairs = feed_.counters();
  noteOne(film().url, pairs.missing, "what is there was played");
  noteOne(film().depth_url, pairs.depth_missing, "from there on the picture was flat, without force");
}

// A film that cannot go on: the next one, or none.
void Player::followFault(MonotonicTime now) {
  if (state_ != PlayerState::Fault || hopeless_) return;
  const bool more = film_ + 1 < films_.size();
  if (!more && !config_.stays) return;  // it ends with that failure
  const std::string what = failure_->thing + ": " + failure_->error.message;
  log(LogLevel::Error, "play", "%s; %s", what.c_str(), more ? "the next film is played" : "it is stopped");
  text_.tell(what, now);
  if (more) return openFilm(film_ + 1, now);
  failure_.reset();
  stopFilm(now);
}

void Player::goOnWhereLeft(MonotonicTime now) {
  if (!resume_ || report_.film.duration <= Duration(0)) return;
  const auto left = resume_->find(film().url);
  if (!left || left->time_since_epoch() >= report_.film.duration) return;
  log(LogLevel::Info, "play", "goes on where it was left, at %.1f s", toSeconds(*left));
  seek(*left, PlayerEvent::Seek, false, now);
}

void Player::keepPosition(MonotonicTime now) {
  if (!resume_ || now < keep_due_) return;
  const auto position = clock_.position(now);
  if (!position || report_.film.duration <= Duration(0) || target_) return;
  if (state_ == PlayerState::Ended) return;
  keep_due_ = now + kKeepPeriod;
  resume_->keep(film().url, *position);
}

}  // namespace relievo
