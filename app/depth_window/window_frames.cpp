// SPDX-License-Identifier: Apache-2.0
// The list of frames in order of time, cut at both ends.
#include "app/depth_window/window_frames.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace relievo {
namespace {

constexpr std::size_t kOver = SurfaceWindow::kBefore + 1, kAhead = SurfaceWindow::kAhead;

template <class Frames>
auto firstAfter(Frames& frames, MediaTime time) {
  return std::ranges::upper_bound(frames, time, {}, &TimedSurface::time);
}

}  // namespace

void WindowFrames::clear() noexcept {
  frames_.clear();
  shots_.forget();
}

bool WindowFrames::moveTo(MediaTime now) {
  now_ = now;
  return trim();
}

bool WindowFrames::add(TimedSurface frame) {
  const MediaTime time = frame.time;
  if (contains(time)) return false;
  frames_.insert(firstAfter(frames_, time), std::move(frame));
  trim();
  shots_.mark(frames_);  // the first frame keeps its shot's number, so the others keep theirs
  return contains(time);
}

bool WindowFrames::trim() {
  const std::size_t before = frames_.size();
  const auto over = static_cast<std::size_t>(firstAfter(frames_, now_) - frames_.begin());
  const auto begin = frames_.begin();
  if (before - over > kAhead) frames_.erase(begin + static_cast<std::ptrdiff_t>(over + kAhead), frames_.end());
  if (over > kOver) frames_.erase(begin, begin + static_cast<std::ptrdiff_t>(over - kOver));
  return frames_.size() != before;
}

int WindowFrames::ahead() const noexcept {
  return static_cast<int>(frames_.end() - firstAfter(frames_, now_));
}

bool WindowFrames::contains(MediaTime time) const noexcept {
  const auto after = firstAfter(frames_, time);
  return after != frames_.begin() && (after - 1)->time == time;
}

const TimedSurface* WindowFrames::at(MediaTime now) const noexcept {
  if (frames_.empty()) return nullptr;
  const auto after = firstAfter(frames_, now);
  return after == frames_.begin() ? &frames_.front() : &*(after - 1);
}

void WindowFrames::fill(SurfaceWindow& window) const {
  window.count = static_cast<int>(frames_.size());
  const auto end = std::ranges::copy(frames_, window.frames.begin()).out;
  std::fill(end, window.frames.end(), TimedSurface{});
}

}  // namespace relievo
