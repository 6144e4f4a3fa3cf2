// SPDX-License-Identifier: Apache-2.0
// The part of a film that the viewer has marked to be repeated. Pure.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "hal/media/media_time.h"

namespace relievo {

class LoopAB {
 public:
  // The first call sets one end of the part, the second the other, a third clears both; so does one without a position.
  void mark(std::optional<MediaTime> here) noexcept {
    if (to_ || !here) return forget();
    if (from_ == here) return;
    if (from_) to_ = std::max(*from_, *here);
    from_ = from_ ? std::min(*from_, *here) : *here;
  }
  void forget() noexcept {
    from_.reset();
    to_.reset();
    went_back_ = 0;
  }
  // Call once a round while the film plays. The position to continue from if `here` is at the part's end or behind it;
  // nullopt before that. A part in which no picture begins is forgotten: from its beginning the film goes on behind it,
  // each time; a slow round alone may do so once.
  [[nodiscard]] std::optional<MediaTime> backFrom(std::optional<MediaTime> here) noexcept {
    const bool behind = to_ && here && *here >= *to_;
    went_back_ = behind ? went_back_ + 1 : 0;
    if (went_back_ > kMostInVain) forget();
    return behind ? from_ : std::nullopt;
  }

  [[nodiscard]] std::optional<MediaTime> from() const noexcept { return from_; }
  [[nodiscard]] std::optional<MediaTime> to() const noexcept { return to_; }

 private:
  static constexpr int kMostInVain = 3;

  std::optional<MediaTime> from_, to_;
  int went_back_ = 0;  // in so many rounds without one between
};

}  // namespace relievo
