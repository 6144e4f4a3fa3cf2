// SPDX-License-Identifier: Apache-2.0
// Chooses how coarse and how small the relief is drawn so that a frame keeps within its budget. Pure arithmetic.
#pragma once

#include <optional>

#include "platform/clock.h"

namespace relievo {

// While the smoothed frame time exceeds the budget and pictures come later and later, first the relief gets coarser:
// the error is the one asked for, multiplied in steps of sqrt(2). Then the view is drawn smaller, down to half its
// width and height, and stretched; at last the relief gets coarser once more. It gets finer again after half the budget
// has been unused for some time. If it then has to get coarser again, the next attempt waits twice as long.
class DetailLevel {
 public:
  static constexpr int kCoarsest = 6;

  explicit DetailLevel(Duration budget) noexcept : budget_(budget) {}

  void setBudget(Duration budget) noexcept { budget_ = budget; }
  // Reports how long drawing a frame at the present level took, and how late its picture was when it began. Where that
  // is not known, a frame over the budget counts as late.
  void drew(Duration took, std::optional<Duration> late = {}) noexcept;
  // Reports how long drawing took before the film's clock starts, with all textures and programs made and nothing else
  // to do. True if the level has changed: try again.
  [[nodiscard]] bool rehearsed(Duration took) noexcept;

  [[nodiscard]] int level() const noexcept { return level_; }
  // Factor on the requested error, in pixels as drawn.
  [[nodiscard]] double factor() const noexcept;
  // Share of the view's width and height in which it is drawn.
  [[nodiscard]] double size() const noexcept;

 private:
  void change(int level) noexcept;
  void getCoarser() noexcept;
  [[nodiscard]] bool isLate(std::optional<Duration> late) noexcept;

  static constexpr int kShortPatience = 30;

  Duration budget_;
  int level_ = 0;
  Duration smoothed_{0};
  int frames_at_level_ = 0;
  Duration last_late_{0};
  int later_frames_ = 0;           // consecutive frames that began later than the one before
  int room_frames_ = 0;            // consecutive frames that left half of the budget
  int patience_ = kShortPatience;  // how many of these it takes to get finer
  bool refined_ = false;           // the last change made it finer
};

}  // namespace relievo
