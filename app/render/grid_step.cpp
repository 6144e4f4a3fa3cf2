// SPDX-License-Identifier: Apache-2.0
// The two rules of the grid's step.
#include "app/render/grid_step.h"

#include <algorithm>

namespace relievo {
namespace {

constexpr int kWarmUpFrames = 3;  // after a change: textures, caches and the driver's compiler settle
constexpr int kOverFrames = 6;    // after those, before it goes coarser
constexpr int kShortPatience = 30;
constexpr int kLongPatience = 30 * 128;  // two minutes at 30 frames/s
constexpr Duration::rep kSmoothing = 8;

}  // namespace

void GridStep::setGrid(int cols, int rows) noexcept {
  if (cols == cols_ && rows == rows_) return;
  cols_ = cols;
  rows_ = rows;
  int step = 1;
  while (vertices(step) > kStartVertices) ++step;
  change(step);
  refined_ = false;
  patience_ = kShortPatience;
}

void GridStep::drew(Duration took) noexcept {
  if (cols_ == 0) return;
  ++frames_at_step_;
  took = std::min(took, 2 * budget_);  // a frame held up by something else tells little about the grid
  if (frames_at_step_ <= kWarmUpFrames) {
    smoothed_ = took;
    return;
  }
  smoothed_ += (took - smoothed_) / kSmoothing;

  if (smoothed_ > budget_) {
    room_frames_ = 0;
    if (frames_at_step_ < kWarmUpFrames + kOverFrames || vertices(step_ + 1) < kFewestVertices) return;
    if (refined_) patience_ = std::min(2 * patience_, kLongPatience);
    refined_ = false;
    change(step_ + 1);
    return;
  }
  if (step_ == 1) return;
  const double finer = static_cast<double>(smoothed_.count()) * static_cast<double>(vertices(step_ - 1)) /
                       static_cast<double>(vertices(step_));
  const bool room = finer < 0.8 * static_cast<double>(budget_.count());
  room_frames_ = room ? room_frames_ + 1 : 0;
  if (room_frames_ < patience_) return;
  refined_ = true;
  change(step_ - 1);
}

long GridStep::vertices(int step) const noexcept {
  return static_cast<long>(verticesAlong(cols_, step)) * verticesAlong(rows_, step);
}

void GridStep::change(int step) noexcept {
  step_ = step;
  frames_at_step_ = 0;
  room_frames_ = 0;
}

}  // namespace relievo
