// SPDX-License-Identifier: Apache-2.0
// When to try again what was lost: soon at first, then ever more seldom.
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
    wait_ = kFirst;
    next_ = now + wait_;
  }
  void failed(MonotonicTime now) noexcept {
    wait_ = std::min(2 * wait_, kLongest);
    next_ = now + wait_;
  }
  [[nodiscard]] MonotonicTime next() const noexcept { return next_; }
  [[nodiscard]] Duration away(MonotonicTime now) const noexcept { return now - since_; }

 private:
  MonotonicTime since_, next_;
  Duration wait_ = kFirst;
};

}  // namespace relievo
