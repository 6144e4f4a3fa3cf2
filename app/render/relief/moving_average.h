// SPDX-License-Identifier: Apache-2.0
// Moving average of the time that a repeated task takes: recent times weigh most. Pure.
#pragma once

#include <cstdint>

#include "platform/clock.h"

namespace relievo {

class MovingAverage {
 public:
  void add(Duration took) noexcept { value_ = count_++ == 0 ? took : value_ + (took - value_) / kSmoothing; }
  // 0 before the first time.
  [[nodiscard]] Duration value() const noexcept { return value_; }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

 private:
  static constexpr Duration::rep kSmoothing = 8;

  Duration value_{0};
  std::uint64_t count_ = 0;
};

}  // namespace relievo
