// SPDX-License-Identifier: Apache-2.0
// Adds up the media time that was played, without pauses. Pure.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "hal/media/media_time.h"
#include "platform/clock.h"

namespace relievo {

class PlayedTime {
 public:
  // Playing starts or resumes at `here`.
  void begin(MediaTime here) noexcept { begin_ = here; }
  // Playing stops at `here` (nullopt: position unknown, not counted). Does nothing if it has stopped already.
  void end(std::optional<MediaTime> here) noexcept {
    const auto begin = std::exchange(begin_, std::nullopt);
    if (begin && here) total_ += std::max(*here - *begin, Duration(0));
  }
  [[nodiscard]] Duration total() const noexcept { return total_; }

 private:
  std::optional<MediaTime> begin_;
  Duration total_{0};
};

}  // namespace relievo
