// SPDX-License-Identifier: Apache-2.0
// Retry schedule for a lost source: quickly at first, then less often. Each wait is an eighth of the time since the
// loss, so that a source which returns after 5 s is found at most about 0.6 s later.
#pragma once

#include <algorithm>

#include "platform/clock.h"

namespace relievo {

class BackOff {
 public:
  static constexpr Duration kFirst = std::chrono::milliseconds(250);
  static constexpr Duration kLongest = std::chrono::seconds(4);

  // The source was lost now; the first retry is due after kFirst.
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
