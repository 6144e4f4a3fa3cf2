// SPDX-License-Identifier: Apache-2.0
// Adds up the time in which a thread had nothing to do. Pure.
#pragma once

#include <optional>

#include "platform/clock.h"

namespace relievo {

class RestTime {
 public:
  void begin(MonotonicTime now) noexcept { since_ = now; }
  void end(MonotonicTime now) noexcept {
    total_ = until(now);
    since_.reset();
  }
  // The total of ended rests, and the total including a rest that is still going on.
  [[nodiscard]] Duration ended() const noexcept { return total_; }
  [[nodiscard]] Duration until(MonotonicTime now) const noexcept { return since_ ? total_ + (now - *since_) : total_; }

 private:
  Duration total_{0};
  std::optional<MonotonicTime> since_;
};

}  // namespace relievo
