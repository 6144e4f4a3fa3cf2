// SPDX-License-Identifier: Apache-2.0
// How far the drawn relief may be off, so that drawing keeps within its budget: pure arithmetic.
#pragma once

#include "platform/clock.h"

namespace relievo {

// As fine as is wished for, in steps of the square root of 2 up to 8 times as coarse while the smoothed time passes the
// budget, and finer again when half of it has been left over for some time. When it had to come back all the same it
// waits twice as long before it tries again.
class DetailLevel {
 public:
  static constexpr int kCoarsest = 6;

  explicit DetailLevel(Duration budget) noexcept : budget_(budget) {}

  // One frame was drawn with the present error.
  void drew(Duration took) noexcept;

  [[nodiscard]] int level() const noexcept { return level_; }
  // By how much the error that is wished for is multiplied.
  [[nodiscard]] double factor() const noexcept;

 private:
  void change(int level) noexcept;

  static constexpr int kShortPatience = 30;

  Duration budget_;
  int level_ = 0;
  Duration smoothed_{0};
  int frames_at_level_ = 0;
  int room_frames_ = 0;            // in a row that left half of the budget
  int patience_ = kShortPatience;  // how many of them it takes
  bool refined_ = false;           // the last change was to a finer level
};

}  // namespace relievo
