// SPDX-License-Identifier: Apache-2.0
// How many of a film's pictures get a relief, and how long making one may take: from what those before it took.
#pragma once

#include "platform/clock.h"

namespace relievo {

class ReliefPace {
 public:
  explicit ReliefPace(Duration period) noexcept : period_(period) {}

  // The time that a relief may take, so that the picture and the finger keep theirs.
  [[nodiscard]] Duration budget() const noexcept;
  // A relief was made in this time.
  void took(Duration cost) noexcept;
  // Every how many pictures one is made. It does not change back and forth.
  [[nodiscard]] int stride() const noexcept { return stride_; }
  [[nodiscard]] double reliefsPerSecond() const noexcept;
  // Fewer than the film has pictures, and than the eye takes for motion.
  [[nodiscard]] bool isSlow() const noexcept;
  [[nodiscard]] double meanSeconds() const noexcept { return mean_s_; }

 private:
  Duration period_;
  double mean_s_ = 0;  // moving
  int stride_ = 1;
};

}  // namespace relievo
