// SPDX-License-Identifier: Apache-2.0
// How many depth samples apart the mesh's vertices stand, so that drawing keeps within its budget: pure arithmetic.
#pragma once

#include "platform/clock.h"

namespace relievo {

// It begins with what software rendering can draw, goes coarser when the smoothed time passes the budget, and finer
// only when the time that the finer grid would take, were all of it spent on vertices, is well within: since part of
// it is not, the finer grid then holds as well, and the two rules do not chase one another. When it had to come back
// all the same it waits twice as long before it tries again.
class GridStep {
 public:
  static constexpr long kStartVertices = 22'500;
  // Below so few the pixels cost more than the vertices: a coarser grid would look worse and draw no faster.
  static constexpr long kFewestVertices = 5'000;

  explicit GridStep(Duration budget) noexcept : budget_(budget) {}

  // Starts anew when the size is another than before.
  void setGrid(int cols, int rows) noexcept;
  // One frame was drawn with the present step.
  void drew(Duration took) noexcept;

  [[nodiscard]] int step() const noexcept { return step_; }
  // Samples 0, step, 2 step, .. and the last one.
  [[nodiscard]] static int verticesAlong(int samples, int step) noexcept { return (samples - 2 + step) / step + 1; }

 private:
  [[nodiscard]] long vertices(int step) const noexcept;
  void change(int step) noexcept;

  Duration budget_;
  int cols_ = 0, rows_ = 0;
  int step_ = 1;
  Duration smoothed_{0};
  int frames_at_step_ = 0;
  int room_frames_ = 0;   // in a row that a finer grid would have fitted
  int patience_ = 0;      // how many of them it takes
  bool refined_ = false;  // the last change was to a finer grid
};

}  // namespace relievo
