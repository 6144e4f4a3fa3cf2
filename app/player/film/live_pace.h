// SPDX-License-Identifier: Apache-2.0
// The pace of a live film: the moment of it that is felt now, and the time of its next picture. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "app/depth_window/look_ahead.h"
#include "app/media/pair_reader.h"
#include "hal/media/media_time.h"
#include "platform/clock.h"

namespace relievo {

// Touch is as recent as its frames allow (Arrivals), but not more than kMostBefore ahead of the pictures, which take
// time to be drawn. Pictures are shown as they arrive, but not more than kMostBehind ahead of touch. One thread.
class LivePace {
 public:
  void forget() noexcept { *this = {}; }
  // Takes the next pair that was read, in order. A pair that was taken before does not count again.
  void hear(const FramePair& pair) noexcept;
  // True if enough pairs arrived to choose a look-ahead, not counting those that the source had buffered.
  [[nodiscard]] bool settled() const noexcept;
  // Chooses the look-ahead from the arrivals so far; once, before the film begins; a later call repeats the result.
  // False if pairs arrived before their time: then the source has a buffer of its own, and its film is played like any
  // other.
  bool choose() noexcept;
  // The result of `choose`; false before it.
  [[nodiscard]] bool asItComes() const noexcept { return as_it_comes_.value_or(false); }
  [[nodiscard]] const LookAhead& lookAhead() const noexcept { return ahead_; }
  // A picture was on the screen when it was this old.
  void shown(Duration age) noexcept;

  // When media time 0 was taken.
  [[nodiscard]] MonotonicTime origin() const noexcept { return origin_; }
  // The age that the felt surface should have, and the corresponding moment of the film.
  [[nodiscard]] Duration age() const noexcept;
  [[nodiscard]] MediaTime wanted(MonotonicTime now) const noexcept;
  // When the next pair is expected.
  [[nodiscard]] MonotonicTime next() const noexcept;

 private:
  // A jitter that is assumed until more is known: a few frames do not show it.
  static constexpr Duration kLeastLate = std::chrono::milliseconds(10);
  static constexpr std::size_t kShown = 32;

  Arrivals arrivals_;
  std::optional<MediaTime> newest_;
  MonotonicTime origin_;
  LookAhead ahead_;
  std::optional<bool> as_it_comes_;       // the result of `choose`
  int since_choice_ = 0;                  // pairs
  std::array<Duration, kShown> shown_{};  // the ages of the last pictures
  std::size_t shown_count_ = 0;
};

}  // namespace relievo
