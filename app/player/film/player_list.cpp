// SPDX-License-Identifier: Apache-2.0
// From film to film: lists, beginnings, ends, and where one was left.
#include <algorithm>
#include <utility>

#include "app/player/player.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kBeginning = std::chrono::seconds(3);  // so near to it, "previous" means the film before
constexpr Duration kKeepPeriod = std::chrono::seconds(2);
constexpr int kMostLists = 20;  // within one another

}  // namespace

void Player::openList(const std::string& url, const std::string& depth_url, MonotonicTime now) {
  if (!nextState(state_, PlayerEvent::Open)) return;
  leaveFilm(now);
  films_ = {{.url = url, .depth_url = depth_url, .title = ""}};
  lists_ = 0;
  played_one_ = false;
  openFilm(0, now);
}

// The film has turned out to be a list: its films stand where it stood.
void Player::followList(MonotonicTime now) {
  if (++lists_ > kMostLists) {
    return fail(film().url, {ErrorCode::Unsupported, 0, "lists within lists without an end; one of them names itself"});
  }
  report_.films.pop_back();  // a list is no film
  const std::vector<PlaylistEntry> listed = feed_.films();
  const auto at = films_.erase(films_.begin() + static_cast<std::ptrdiff_t>(film_));
  films_.insert(at, listed.begin(), listed.end());
  std::size_t first = film_;
  if (const auto last = resume_ && lists_ == 1 ? resume_->last() : std::nullopt) {
    const auto is_last = [&](const PlaylistEntry& entry) { return Resume::keyOf(entry.url) == *last; };
    const auto seen = std::ranges::find_if(films_, is_last);
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
  if (films_[film].refused) {
    return fail(source.url, {ErrorCode::Unsupported, 0,
                             "a list may not name this: http, https, rtsp, rtp, udp, tcp and, in a file, paths"});
  }
  feed_.open(std::move(source));
  film_open_ = true;
}

void Player::previousFilm(MonotonicTime now) {
  const bool at_beginning = seekBase(now) < MediaTime(kBeginning);
  if (at_beginning && film_ > 0) {
    openFilm(film_ - 1, now);
    backwards_ = true;
    return;
  }
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
  played_one_ = played_one_ || scene_known_;
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
    note(print("%s breaks off %.1f s before its end, cut off or damaged", url.c_str(), toSeconds(missing)), done);
  };
  const PairCounters pairs = feed_.counters();
  if (pairs.damaged > 0) {
    note(print("%llu pictures of %s are damaged", static_cast<unsigned long long>(pairs.damaged), film().url.c_str()),
         "what could be decoded was shown");
  }
  noteOne(film().url, pairs.missing, "what is there was played");
  noteOne(film().depth_url, pairs.depth_missing, "from there on the picture was flat, without force");
}

// A film that cannot go on: the next one on the viewer's way, or none. A list of which something was played has not
// failed.
void Player::followFault(MonotonicTime now) {
  if (state_ != PlayerState::Fault || hopeless_) return;
  std::optional<std::size_t> other;
  if (backwards_ && film_ > 0) other = film_ - 1;
  else if (film_ + 1 < films_.size()) other = film_ + 1;
  else if (config_.loop && played_one_) other = 0;
  if (!other && !config_.stays && !played_one_) return;  // it ends with that failure
  const std::string what = failure_->thing + ": " + failure_->error.message;
  log(LogLevel::Error, "play", "%s; %s", what.c_str(), other ? "another film is played" : "it is stopped");
  text_.tell(what, now);
  if (other == 0U) played_one_ = false;
  const bool backwards = backwards_ && other && *other < film_;
  if (other) openFilm(*other, now);
  backwards_ = backwards;
  if (other) return;
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
  const auto position = place(now);
  if (!position || report_.film.duration <= Duration(0) || target_) return;
  if (state_ == PlayerState::Ended) return;
  keep_due_ = now + kKeepPeriod;
  resume_->keep(film().url, *position);
}

}  // namespace relievo
