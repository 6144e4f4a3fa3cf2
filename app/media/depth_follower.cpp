// SPDX-License-Identifier: Apache-2.0
// Pairs depth with colour by timestamp and decides what a gap in the depth track means.
#include "app/media/depth_follower.h"

#include <algorithm>
#include <utility>

namespace relievo {
namespace {

constexpr Duration kRounding = std::chrono::milliseconds(1);
constexpr Duration kJitter = std::chrono::milliseconds(4);

}  // namespace

DepthFollower::DepthFollower(Supply supply) : supply_(std::move(supply)) {}

Result<DepthFollower::Match> DepthFollower::at(MediaTime color) {
  while (!live_ || current_.empty() || color - current_.pts > tolerance()) {
    const auto there = fetch();
    if (!there) return std::unexpected(there.error());
    if (!*there || next_->pts > color + tolerance()) break;
    if (!current_.empty() && !asked_for_ && !catching_up_) ++skipped_;
    current_ = *std::exchange(next_, std::nullopt);
    asked_for_ = false;
  }
  catching_up_ = false;
  asked_for_ = true;
  if (current_.empty()) return Match{};
  return judge(color - current_.pts);
}

DepthFollower::Match DepthFollower::judge(Duration age) const {
  const Duration usual = period();
  const bool fresh = usual == Duration(0) || age < usual - tolerance();
  const bool in_step = next_ && next_->pts - current_.pts <= usual * 3 / 2;  // late, but no picture is missing
  if (fresh || in_step) return {current_, true};
  if (!next_ && ended_) return {};
  return {current_, false};
}

Result<const Frame*> DepthFollower::peek() {
  const auto there = fetch();
  if (!there) return std::unexpected(there.error());
  return *there ? &*next_ : nullptr;
}

// True when `next_` now holds a picture.
Result<bool> DepthFollower::fetch() {
  if (next_) return true;
  if (ended_) return false;
  auto supplied = supply_();
  if (!supplied) return std::unexpected(supplied.error());
  if (!supplied->frame) {
    ended_ = supplied->ended;
    return false;
  }
  next_ = std::move(supplied->frame);
  if (last_pts_ && next_->pts > *last_pts_) steps_[step_count_++ % kSteps] = next_->pts - *last_pts_;
  last_pts_ = next_->pts;
  return true;
}

void DepthFollower::restart() noexcept {
  current_ = Frame{};
  next_.reset();
  last_pts_.reset();
  ended_ = false;
  catching_up_ = true;
}

Duration DepthFollower::period() const noexcept {
  const std::size_t count = std::min(step_count_, kSteps);
  if (count == 0) return Duration(0);
  auto steps = steps_;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
  std::nth_element(steps.begin(), middle, steps.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

// Returns the largest tolerance until the frame period is known.
Duration DepthFollower::tolerance() const noexcept {
  return step_count_ == 0 ? kJitter : std::clamp(period() / 8, kRounding, kJitter);
}

}  // namespace relievo
