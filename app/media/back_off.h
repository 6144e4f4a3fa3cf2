// SPDX-License-Identifier: Apache-2.0
// When to try again what was lost: soon at first, then ever more seldom. Each wait is an eighth of the time that it has
// been away, so that what comes back is missed by no more than that: one that was away for 5 s is back 0.6 s later.
#pragma once

#include <algorithm>

#include "platform/clock.h"

namespace relievo {

class BackOff {
 public:
  static constexpr Duration kFirst = std::chrono::milliseconds(250);
  static constexpr Duration kLongest = std::chrono::seconds(4);

  // It is lost: the first try is due after kFirst.
  void begin(MonotonicTime now) noexcept {
    since_ = now;
    next_ = now + kFirst;
  }
  void failed(MonotonicTime now) noexcept { next_ = now + std::clamp<Duration>(away(now) / 8, kFirst, kLongest); }
  [[nodiscard]] MonotonicTime next() const noexcept { return next_; }
  [[nodiscard]] Duration away(MonotonicTime now) const noexcept { return now - since_; }

 private:
  MonotonicTime since_, next_;
};

}  // namespace relievo
