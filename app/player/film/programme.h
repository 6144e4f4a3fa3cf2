// SPDX-License-Identifier: Apache-2.0
// The list of films: which one is played, its neighbours, and where the viewer left each. Does no I/O except for the
// file of positions (Resume).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/media/playlist.h"
#include "app/player/film/resume.h"
#include "hal/media/media_time.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

class Programme {
 public:
  static constexpr int kMostLists = 20;  // a list may contain lists, but not endlessly
  static constexpr Duration kKeepPeriod = std::chrono::seconds(2);
  enum class Way : std::uint8_t { Forward, Back };  // the direction to the next film tried if one cannot be played

  // `resume_path`: the file of positions; if empty, each film starts from the beginning. `files` must outlive it.
  Programme(const std::string& resume_path, FileWriter& files, bool loop);

  // Replaces the whole list by these films or lists, at least one.
  void begin(std::vector<PlaylistEntry> films);
  // Replaces the present entry, which is a list, by the list's entries. Returns the entry to open first: the one that
  // the viewer saw last, else the list's first. Unsupported if lists are nested too deeply.
  [[nodiscard]] Result<std::size_t> spread(const std::vector<PlaylistEntry>& films);

  // Makes this entry the present one.
  void choose(std::size_t film, Way way) noexcept;
  // The present film has been opened: a later failure is passed over forwards.
  void opened() noexcept { way_ = Way::Forward; }
  // The present film is being closed. `seen`: at least one of its pictures was shown.
  void left(bool seen) noexcept { seen_one_ = seen_one_ || seen; }

  // What to play when the present film has ended; the present one itself if a single film loops. Nullopt: nothing.
  [[nodiscard]] std::optional<std::size_t> afterEnd() const noexcept;
  // What to play when the present film has failed: the next one in the viewer's direction. Nullopt: nothing.
  [[nodiscard]] std::optional<std::size_t> afterFault() const noexcept;
  // Call when the present film has failed and `other` is tried: returns the direction to it. Wrapping round to the
  // first film forgets that a film was seen, so that a looping list ends once none of its films can be played.
  [[nodiscard]] Way passOver(std::size_t other) noexcept;

  [[nodiscard]] const PlaylistEntry& film() const noexcept { return films_[present_]; }
  [[nodiscard]] std::size_t present() const noexcept { return present_; }
  [[nodiscard]] std::size_t size() const noexcept { return films_.size(); }
  [[nodiscard]] Way way() const noexcept { return way_; }
  // `begin` has been called.
  [[nodiscard]] bool asked() const noexcept { return asked_; }
  [[nodiscard]] bool loops() const noexcept { return loop_; }
  // Several films, one after the other and from the first again.
  [[nodiscard]] bool wraps() const noexcept { return loop_ && films_.size() > 1; }
  void setLoop(bool loop) noexcept { loop_ = loop; }

  // Where the viewer left the present film, whose length is `length`; nullopt if unknown or if the film has no length.
  [[nodiscard]] std::optional<MediaTime> whereLeft(Duration length) const;
  // The films that the viewer left: the key of each (Resume::keyOf) and the position in seconds, the last one first.
  [[nodiscard]] std::vector<std::pair<std::string, double>> leftFilms() const;
  // Keeps the viewer's position, at most every kKeepPeriod. Nullopt: unknown, nothing is kept.
  void keep(std::optional<MediaTime> place, MonotonicTime now);
  // Keeps it at once, when the film is closed.
  void keepAtOnce(std::optional<MediaTime> place, MonotonicTime now);
  // The viewer has seen the present film to its end: it starts from the beginning next time.
  void forgetPlace();
  // See Resume::isKept; true without a file of positions.
  [[nodiscard]] bool placesAreKept() const noexcept { return !resume_ || resume_->isKept(); }

 private:
  std::optional<Resume> resume_;
  bool loop_;
  bool asked_ = false;
  std::vector<PlaylistEntry> films_ = std::vector<PlaylistEntry>(1);  // an empty entry until `begin`
  std::size_t present_ = 0;
  int lists_ = 0;  // spread since `begin`
  Way way_ = Way::Forward;
  bool seen_one_ = false;
  MonotonicTime keep_due_;
};

}  // namespace relievo
