// SPDX-License-Identifier: Apache-2.0
// The two rules that change the level.
#include "app/render/relief/detail_level.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>

namespace relievo {
namespace {

constexpr int kWarmUpFrames = 3;  // after a change, until textures, caches and the driver's compiler have settled
constexpr int kOverFrames = 6;    // frames over budget before the level gets coarser
constexpr int kLongPatience = 30 * 128;  // two minutes at 30 frames/s
constexpr Duration::rep kSmoothing = 8;

struct Step {
  double factor, size;
};
constexpr double kRoot = std::numbers::sqrt2;
constexpr std::array<Step, DetailLevel::kCoarsest + 1> kSteps{
    {{1, 1}, {kRoot, 1}, {2, 1}, {2 * kRoot, 1}, {2 * kRoot, 0.8}, {2 * kRoot, 0.64}, {2 * kRoot, 0.5}, {4, 0.5}}};

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
    const bool far_over = smoothed_ > budget_ * 3 / 2;
    change(std::min(level_ + (far_over ? 2 : 1), kCoarsest));
    return;
  }
  room_frames_ = smoothed_ < budget_ / 2 ? room_frames_ + 1 : 0;
  if (level_ == 0 || room_frames_ < patience_) return;
  refined_ = true;
  change(level_ - 1);
}

double DetailLevel::factor() const noexcept {
  return kSteps[static_cast<std::size_t>(level_)].factor;
}

double DetailLevel::size() const noexcept {
  return kSteps[static_cast<std::size_t>(level_)].size;
}

void DetailLevel::change(int level) noexcept {
  level_ = level;
  frames_at_level_ = 0;
  room_frames_ = 0;
}

}  // namespace relievo
