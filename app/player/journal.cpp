// SPDX-License-Identifier: Apache-2.0
// Fills the report, and calls the listener at once.
#include "app/player/journal.h"

#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

constexpr std::size_t kMostStates = 10'000;  // enough for a look at a film that loops for months
constexpr std::size_t kMostFilms = 1000;     // likewise, at a list

}  // namespace

void Journal::stateChanged(PlayerState state) {
  if (report_.states.size() < kMostStates) report_.states.push_back(state);
}

void Journal::filmAsked(const std::string& url, const std::string& depth_url) {
  for (const std::string& address : {url, depth_url}) {
    const bool is_file = address.find("://") == address.npos || address.starts_with("file:");
    if (is_file && !address.empty()) report_.opened.insert(address);
  }
  film_kept_ = report_.films.size() < kMostFilms;
  if (film_kept_) report_.films.push_back(url);
}

void Journal::filmIsList() {
  if (std::exchange(film_kept_, false)) report_.films.pop_back();
}

void Journal::note(const std::string& what, const std::string& done, std::optional<MonotonicTime> when) {
  const MonotonicTime time = when.value_or(clock_.now());
  const bool fresh = report_.addFault(sinceBegin(time), what, done);
  const FaultEntry fault{sinceBegin(time), what, done};
  if (fresh) log(LogLevel::Warning, "play", "%s", fault.sentence().c_str());
  if (listener_) listener_(fault, time, fresh);
}

void Journal::noteStop(const std::string& what) {
  const MonotonicTime now = clock_.now();
  report_.addFault(sinceBegin(now), what, "stopped");
  if (listener_) listener_({sinceBegin(now), what, "stopped"}, now, false);
}

void Journal::noteQuietly(const std::string& what, const std::string& done) {
  report_.addFault(sinceBegin(clock_.now()), what, done);
}

}  // namespace relievo
