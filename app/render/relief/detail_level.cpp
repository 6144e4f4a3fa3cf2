// SPDX-License-Identifier: Apache-2.0
// The rules that change the level.
#include "app/render/relief/detail_level.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>

namespace relievo {
namespace {

constexpr int kWarmUpFrames = 3;  // after a change, until textures, caches and the driver's compiler have settled
constexpr int kOverFrames = 6;    // frames over budget before the level gets coarser, where lateness is unknown
constexpr int kLaterFrames = 2;   // frames, each later than the one before, that prove that drawing is too slow
constexpr int kLongPatience = 30 * 128;  // two minutes at 30 frames/s
constexpr Duration::rep kSmoothing = 8;

// Stretching costs a software driver what a third of the pixels do: a view of .8 is no cheaper than the whole.
struct Step {
  double factor, size;
};
constexpr double kRoot = std::numbers::sqrt2;
constexpr std::array<Step, DetailLevel::kCoarsest + 1> kSteps{
    {{1, 1}, {kRoot, 1}, {2, 1}, {2 * kRoot, 1}, {2 * kRoot, 0.64}, {2 * kRoot, 0.5}, {4, 0.5}}};

}  // namespace

void DetailLevel::drew(Duration took, std::optional<Duration> late) noexcept {
  ++frames_at_level_;
  const bool is_late = isLate(late);
  took = std::min(took, 2 * budget_);  // limit outliers: a frame delayed by something else says little about the relief
  smoothed_ = frames_at_level_ <= kWarmUpFrames ? took : smoothed_ + (took - smoothed_) / kSmoothing;
  if (smoothed_ > budget_) {
    room_frames_ = 0;
    if (is_late && level_ < kCoarsest) getCoarser();
    return;
  }
  if (frames_at_level_ <= kWarmUpFrames) return;
  room_frames_ = smoothed_ < budget_ / 2 ? room_frames_ + 1 : 0;
  if (level_ == 0 || room_frames_ < patience_) return;
  refined_ = true;
  change(level_ - 1);
}

bool DetailLevel::rehearsed(Duration took) noexcept {
  if (took <= budget_ * 5 / 4 || level_ == kCoarsest) return false;
  smoothed_ = took;
  getCoarser();
  return true;
}

// A picture that was delayed by something else leaves those after it late too, but less and less. A film that drawing
// cannot follow is later with each picture, until one is left out.
bool DetailLevel::isLate(std::optional<Duration> late) noexcept {
  if (!late) return frames_at_level_ >= kWarmUpFrames + kOverFrames;
  later_frames_ = *late > budget_ / 3 && *late > last_late_ ? later_frames_ + 1 : 0;
  last_late_ = *late;
  return later_frames_ >= kLaterFrames && frames_at_level_ > 1;
}

void DetailLevel::getCoarser() noexcept {
  if (refined_) patience_ = std::min(2 * patience_, kLongPatience);
  refined_ = false;
  const bool far_over = smoothed_ > budget_ * 3 / 2;
  change(std::min(level_ + (far_over ? 2 : 1), kCoarsest));
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
  later_frames_ = 0;
  room_frames_ = 0;
}

}  // namespace relievo
