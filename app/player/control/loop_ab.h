// SPDX-License-Identifier: Apache-2.0
// The part of a film that the viewer has marked to be repeated. Pure.
#pragma once

#include <optional>
#include <utility>

#include "hal/media/media_time.h"

namespace relievo {

class LoopAB {
 public:
  // The first call sets the part's beginning, the second its end, a third clears both; so does one without a position.
  void mark(std::optional<MediaTime> here) noexcept {
    if (to_ || !here) forget();
    else if (!from_) from_ = here;
    else if (*here > *from_) to_ = here;
  }
  void forget() noexcept {
    from_.reset();
    to_.reset();
    went_back_ = false;
  }
  // Call once a round while the film plays. The position to continue from if `here` is at the part's end or behind it;
  // nullopt before that. A part in which no picture begins is forgotten: from its beginning the film goes on behind it.
  [[nodiscard]] std::optional<MediaTime> backFrom(std::optional<MediaTime> here) noexcept {
    const bool behind = to_ && here && *here >= *to_;
    if (std::exchange(went_back_, behind) && behind) forget();
    return behind ? from_ : std::nullopt;
  }

  [[nodiscard]] std::optional<MediaTime> from() const noexcept { return from_; }
  [[nodiscard]] std::optional<MediaTime> to() const noexcept { return to_; }

 private:
  std::optional<MediaTime> from_, to_;
  bool went_back_ = false;  // the last round
};

}  // namespace relievo
