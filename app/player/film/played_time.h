// SPDX-License-Identifier: Apache-2.0
// Adds up how much of the films was shown, without the pauses. Pure.
#pragma once

#include <optional>
#include <utility>

#include "hal/media_time.h"
#include "platform/clock.h"

namespace relievo {

class PlayedTime {
 public:
  // The film goes on from here.
  void begin(MediaTime here) noexcept { begin_ = here; }
  // It stands, is sought or ends here; nothing: it had no clock. Does nothing while it does not go.
  void end(std::optional<MediaTime> here) noexcept {
    const auto begin = std::exchange(begin_, std::nullopt);
    if (begin && here) total_ += *here - *begin;
  }
  [[nodiscard]] Duration total() const noexcept { return total_; }

 private:
  std::optional<MediaTime> begin_;
  Duration total_{0};
};

}  // namespace relievo
