// SPDX-License-Identifier: Apache-2.0
// Writes down what happens while the player runs. The player never reads it back: it is for the report.
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
  // Hears each fault as it is noted. `fresh`: it is the first of its name, and worth telling the viewer.
  using Listener = std::function<void(const FaultEntry& fault, MonotonicTime when, bool fresh)>;

  explicit Journal(const Clock& clock, Listener listener = {})
      : clock_(clock), listener_(std::move(listener)), began_(clock.now()) {}

  // Times count from here.
  void begin() { began_ = clock_.now(); }
  [[nodiscard]] MonotonicTime began() const noexcept { return began_; }
  [[nodiscard]] double sinceBegin(MonotonicTime time) const noexcept { return toSeconds(time - began_); }

  void stateChanged(PlayerState state);
  void filmAsked(const std::string& url) { report_.films.push_back(url); }
  void filmIsList() { report_.films.pop_back(); }  // the source asked for last is no film
  void filmOpened(const FilmInfo& info) { report_.film = info; }

  // Something went wrong, and the player did `done` about it. The log and the listener get it as well.
  void note(const std::string& what, const std::string& done, std::optional<MonotonicTime> when = {});
  // The film stops for it. Whoever stops it logs it.
  void noteStop(const std::string& what);
  // For the report alone: someone else has logged it.
  void noteQuietly(const std::string& what, const std::string& done);

  // What has been written so far: the states, the films, the faults. The rest of the report comes from the parts.
  [[nodiscard]] const PlayReport& written() const noexcept { return report_; }

 private:
  const Clock& clock_;
  Listener listener_;
  MonotonicTime began_;
  PlayReport report_;
};

}  // namespace relievo
