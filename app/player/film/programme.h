// SPDX-License-Identifier: Apache-2.0
// Which film is played, which comes before and after it, and where the viewer left each. Pure, but for the file of
// places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/media/playlist.h"
#include "app/player/film/resume.h"
#include "hal/media_time.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

class Programme {
 public:
  static constexpr int kMostLists = 20;  // a list may hold lists, but not without end
  static constexpr Duration kKeepPeriod = std::chrono::seconds(2);
  enum class Way : std::uint8_t { Forward, Back };  // which neighbour is tried where a film cannot be played

  // The file of places; empty: each film begins at its beginning.
  Programme(const std::string& resume_path, bool loop);

  // Another film or list, alone in the programme.
  void begin(const PlaylistEntry& film);
  // The present film is a list: its films take its place. Returns the one to open first: the one that the viewer saw
  // last, else the first of the list. Fails for lists within lists without end.
  [[nodiscard]] Result<std::size_t> spread(const std::vector<PlaylistEntry>& films);

  // The present film becomes this one of the programme.
  void choose(std::size_t film, Way way) noexcept;
  // The present film is open: the viewer has arrived, on whatever way.
  void opened() noexcept { way_ = Way::Forward; }
  // The present film is left. `seen`: at least one of its pictures was shown.
  void left(bool seen) noexcept { seen_one_ = seen_one_ || seen; }

  // The film after the present one has ended; the present one itself where a single film loops. Nothing: it is over.
  [[nodiscard]] std::optional<std::size_t> afterEnd() const noexcept;
  // The film after the present one has failed: the next one on the viewer's way. Nothing: there is none.
  [[nodiscard]] std::optional<std::size_t> afterFault() const noexcept;
  // The present film has failed and `other` is tried: returns the way to it. From the first film on nothing counts as
  // seen any more, so that a list that loops ends once no film of it can be played.
  [[nodiscard]] Way passOver(std::size_t other) noexcept;

  [[nodiscard]] const PlaylistEntry& film() const noexcept { return films_[present_]; }
  [[nodiscard]] std::size_t present() const noexcept { return present_; }
  [[nodiscard]] std::size_t size() const noexcept { return films_.size(); }
  [[nodiscard]] Way way() const noexcept { return way_; }
  // Something of this programme was shown: it has not failed as a whole.
  [[nodiscard]] bool seenOne() const noexcept { return seen_one_; }
  // A film has been asked for, played or not.
  [[nodiscard]] bool asked() const noexcept { return asked_; }
  [[nodiscard]] bool loops() const noexcept { return loop_; }
  void setLoop(bool loop) noexcept { loop_ = loop; }

  // Where the viewer left the present film, `length` long; nothing: nowhere, or the length is not known.
  [[nodiscard]] std::optional<MediaTime> whereLeft(Duration length) const;
  // The viewer is there now. Kept every kKeepPeriod; nothing: the place is not known.
  void keep(std::optional<MediaTime> place, MonotonicTime now);
  // Likewise, and kept at once: the film is left.
  void keepAtOnce(std::optional<MediaTime> place, MonotonicTime now);
  // The viewer has seen the present film to its end.
  void forgetPlace();

 private:
  std::optional<Resume> resume_;
  bool loop_;
  bool asked_ = false;
  std::vector<PlaylistEntry> films_ = std::vector<PlaylistEntry>(1);  // one without a name until one is asked for
  std::size_t present_ = 0;
  int lists_ = 0;  // that were spread since `begin`
  Way way_ = Way::Forward;
  bool seen_one_ = false;
  MonotonicTime keep_due_;
};

}  // namespace relievo
