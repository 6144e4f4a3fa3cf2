// SPDX-License-Identifier: Apache-2.0
// The two rules that change the level.
#include "app/render/relief/detail_level.h"

#include <algorithm>
#include <cmath>

namespace relievo {
namespace {

constexpr int kWarmUpFrames = 3;  // after a change, until textures, caches and the driver's compiler have settled
constexpr int kOverFrames = 6;    // frames over budget before the level gets coarser
constexpr int kLongPatience = 30 * 128;  // two minutes at 30 frames/s
constexpr Duration::rep kSmoothing = 8;

}  // namespace

void DetailLevel::drew(Duration took) noexcept {
  ++frames_at_level_;
  took = std::min(took, 2 * budget_);  // limit outliers: a frame delayed by something else says little about the relief
  if (frames_at_level_ <= kWarmUpFrames) {
    smoothed_ = took;
    return;
  }
  smoothed_ += (took - smoothed_) / kSmoothing;
  if (smoothed_ > budget_) {
    room_frames_ = 0;
    if (frames_at_level_ < kWarmUpFrames + kOverFrames || level_ == kCoarsest) return;
    if (refined_) patience_ = std::min(2 * patience_, kLongPatience);
    refined_ = false;
    change(level_ + 1);
    return;
  }
  room_frames_ = smoothed_ < budget_ / 2 ? room_frames_ + 1 : 0;
  if (level_ == 0 || room_frames_ < patience_) return;
  refined_ = true;
  change(level_ - 1);
}

double DetailLevel::factor() const noexcept {
  return std::exp2(0.5 * level_);
}

void DetailLevel::change(int level) noexcept {
  level_ = level;
  frames_at_level_ = 0;
  room_frames_ = 0;
}

}  // namespace relievo
