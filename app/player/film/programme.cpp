// SPDX-License-Identifier: Apache-2.0
// Moves through the list of films: forward, back, past films that cannot be played, and from the end to the beginning.
#include "app/player/film/programme.h"

#include <algorithm>
#include <utility>

namespace relievo {

Programme::Programme(const std::string& resume_path, FileWriter& files, bool loop) : loop_(loop) {
  if (!resume_path.empty()) resume_.emplace(resume_path, files);
}

void Programme::begin(std::vector<PlaylistEntry> films) {
  films_ = std::move(films);
  present_ = 0;
  lists_ = 0;
  seen_one_ = false;
  asked_ = true;
}

Result<std::size_t> Programme::spread(const std::vector<PlaylistEntry>& films) {
  if (++lists_ > kMostLists) {
    return fail(ErrorCode::Unsupported, "playlists nested too deeply; one of them may contain itself");
  }
  const auto at = films_.erase(films_.begin() + static_cast<std::ptrdiff_t>(present_));
  films_.insert(at, films.begin(), films.end());
  const auto last = resume_ && lists_ == 1 ? resume_->last() : std::nullopt;
  if (!last) return present_;
  const auto is_last = [&](const PlaylistEntry& entry) { return Resume::keyOf(entry.url) == *last; };
  const auto seen = std::ranges::find_if(films, is_last);
  return present_ + (seen == films.end() ? 0 : static_cast<std::size_t>(seen - films.begin()));
}

void Programme::choose(std::size_t film, Way way) noexcept {
  present_ = film;
  way_ = way;
}

std::optional<std::size_t> Programme::afterEnd() const noexcept {
  if (present_ + 1 < films_.size()) return present_ + 1;
  return loop_ ? std::optional<std::size_t>(0) : std::nullopt;
}

std::optional<std::size_t> Programme::afterFault() const noexcept {
  if (way_ == Way::Back && present_ > 0) return present_ - 1;
  if (present_ + 1 < films_.size()) return present_ + 1;
  return loop_ && seen_one_ ? std::optional<std::size_t>(0) : std::nullopt;
}

Programme::Way Programme::passOver(std::size_t other) noexcept {
  if (other == 0) seen_one_ = false;
  return way_ == Way::Back && other < present_ ? Way::Back : Way::Forward;
}

std::optional<MediaTime> Programme::whereLeft(Duration length) const {
  if (!resume_ || length <= Duration(0)) return std::nullopt;
  const auto left = resume_->find(film().url);
  return left && left->time_since_epoch() < length ? left : std::nullopt;
}

std::vector<std::pair<std::string, double>> Programme::leftFilms() const {
  return resume_ ? resume_->all() : std::vector<std::pair<std::string, double>>{};
}

void Programme::keep(std::optional<MediaTime> place, MonotonicTime now) {
  if (now >= keep_due_) keepAtOnce(place, now);
}

void Programme::keepAtOnce(std::optional<MediaTime> place, MonotonicTime now) {
  if (!resume_ || !place) return;
  keep_due_ = now + kKeepPeriod;
  resume_->keep(film().url, *place);
}

void Programme::forgetPlace() {
  if (resume_) resume_->forget(film().url);
}

}  // namespace relievo
