// SPDX-License-Identifier: Apache-2.0
// Collects the contents of the report: states, films and faults. The player never reads them back.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "app/player/report.h"
#include "app/player/state_table.h"
#include "platform/clock.h"

namespace relievo {

// The player's thread only.
class Journal {
 public:
  // Called for each fault. `fresh`: the first fault of its name, which is shown to the viewer.
  using Listener = std::function<void(const FaultEntry& fault, MonotonicTime when, bool fresh)>;

  explicit Journal(const Clock& clock, Listener listener = {})
      : clock_(clock), listener_(std::move(listener)), began_(clock.now()) {}

  // Sets the time from which all other times count.
  void begin() { began_ = clock_.now(); }
  [[nodiscard]] MonotonicTime began() const noexcept { return began_; }
  [[nodiscard]] double sinceBegin(MonotonicTime time) const noexcept { return toSeconds(time - began_); }

  void stateChanged(PlayerState state);
  // `depth_url`: empty if it is not given with the film.
  void filmAsked(const std::string& url, const std::string& depth_url = "");
  void filmIsList();  // the last source is a list, not a film
  // The film that is played, with its chosen tracks.
  void filmIs(const FilmInfo& info) { report_.film = info; }

  // A fault, and what the player did about it; also goes to the log and the listener.
  void note(const std::string& what, const std::string& done, std::optional<MonotonicTime> when = {});
  // A fault that stops the film; the caller logs it.
  void noteStop(const std::string& what);
  // For the report alone: the fault has been logged elsewhere.
  void noteQuietly(const std::string& what, const std::string& done);

  // The states, films and faults so far. The player's parts add the rest of the report.
  [[nodiscard]] const PlayReport& written() const noexcept { return report_; }

 private:
  const Clock& clock_;
  Listener listener_;
  MonotonicTime began_;
  bool film_kept_ = false;  // the last one is in the report
  PlayReport report_;
};

}  // namespace relievo
