// SPDX-License-Identifier: Apache-2.0
// Decides how many pictures get a relief, and how long making one may take, from the time that earlier ones took.
#pragma once

#include "platform/clock.h"

namespace relievo {

class ReliefPace {
 public:
  explicit ReliefPace(Duration period) noexcept : period_(period) {}

  // The time that one relief may take without delaying picture and finger.
  [[nodiscard]] Duration budget() const noexcept;
  // A relief took this long.
  void took(Duration cost) noexcept;
  // A relief is made for every `stride`-th picture. The value does not oscillate.
  [[nodiscard]] int stride() const noexcept { return stride_; }
  [[nodiscard]] double reliefsPerSecond() const noexcept;
  // True if there are fewer reliefs than pictures, and too few for the eye to see motion.
  [[nodiscard]] bool isSlow() const noexcept;
  [[nodiscard]] double meanSeconds() const noexcept { return mean_s_; }

 private:
  Duration period_;
  double mean_s_ = 0;  // moving average
  int stride_ = 1;
};

}  // namespace relievo
