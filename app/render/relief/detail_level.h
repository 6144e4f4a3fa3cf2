// SPDX-License-Identifier: Apache-2.0
// Chooses how coarse the relief may be drawn so that a frame keeps within its budget. Pure arithmetic.
#pragma once

#include "platform/clock.h"

namespace relievo {

// The error is the one asked for, multiplied in steps of sqrt(2), up to 8 times, while the smoothed frame time exceeds
// the budget. It gets finer again after half the budget has been unused for some time. If it then has to get coarser
// again, the next attempt waits twice as long.
class DetailLevel {
 public:
  static constexpr int kCoarsest = 6;

  explicit DetailLevel(Duration budget) noexcept : budget_(budget) {}

  // Tells how long it took to draw a frame at the present level.
  void drew(Duration took) noexcept;

  [[nodiscard]] int level() const noexcept { return level_; }
  // Factor on the error asked for.
  [[nodiscard]] double factor() const noexcept;

 private:
  void change(int level) noexcept;

  static constexpr int kShortPatience = 30;

  Duration budget_;
  int level_ = 0;
  Duration smoothed_{0};
  int frames_at_level_ = 0;
  int room_frames_ = 0;            // consecutive frames that left half of the budget
  int patience_ = kShortPatience;  // how many of these it takes to get finer
  bool refined_ = false;           // the last change made it finer
};

}  // namespace relievo
