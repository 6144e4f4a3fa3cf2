// SPDX-License-Identifier: Apache-2.0
// The pair on the screen and the few after it: picks by time, never by count.
#pragma once

#include <deque>

#include "app/media/film_feed.h"
#include "app/media/pair_reader.h"
#include "hal/media_time.h"

namespace relievo {

class Playhead {
 public:
  static constexpr std::size_t kAhead = 4;  // as far as the depth window reaches

  // Takes pairs from the feed until there are kAhead. False when no more will come.
  bool refill(FilmFeed& feed);
  // Makes the newest pair at or before `position` the present one, refilling meanwhile. Returns how many pairs it went
  // on by: one is the usual, each more is a picture that nobody saw.
  std::size_t advance(MediaTime position, FilmFeed& feed);
  // The first pair after a start or a seek becomes the present one, whatever its time. Not when there is none.
  void begin();
  // Forgets what lies ahead; the present pair stays.
  void clear() { ahead_.clear(); }

  [[nodiscard]] const FramePair& present() const noexcept { return present_; }
  [[nodiscard]] const std::deque<FramePair>& ahead() const noexcept { return ahead_; }
  [[nodiscard]] bool filled() const noexcept { return ahead_.size() >= kAhead; }
  // No pair will come after those ahead.
  [[nodiscard]] bool last() const noexcept { return last_; }

 private:
  FramePair present_;
  std::deque<FramePair> ahead_;
  bool last_ = false;
};

}  // namespace relievo
