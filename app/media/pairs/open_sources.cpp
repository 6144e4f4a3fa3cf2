// SPDX-License-Identifier: Apache-2.0
// A replaced or closed source is destroyed outside the lock, since that joins threads and may wait for a server.
#include "app/media/pairs/open_sources.h"

#include <utility>

namespace relievo {
namespace {

constexpr Duration kStall = std::chrono::milliseconds(300);  // a file's read that takes longer is not the machine's
constexpr Error kInterrupted{ErrorCode::Cancelled, 0, "interrupted before it was opened"};

}  // namespace

Result<void> OpenSources::take(std::unique_ptr<TrackReader> color) {
  const std::scoped_lock lock(mutex_);
  if (interrupted_) return std::unexpected(kInterrupted);
  color_.swap(color);
  return {};
}

Result<void> OpenSources::take(std::unique_ptr<DepthSource> depth) {
  const std::scoped_lock lock(mutex_);
  if (interrupted_) return std::unexpected(kInterrupted);
  depth_.swap(depth);
  return {};
}

void OpenSources::allow() noexcept {
  const std::scoped_lock lock(mutex_);
  interrupted_ = false;
}

void OpenSources::dropDepth() noexcept {
  std::unique_ptr<DepthSource> dropped;
  const std::scoped_lock lock(mutex_);
  depth_.swap(dropped);
}

void OpenSources::close() noexcept {
  std::unique_ptr<TrackReader> color;
  std::unique_ptr<DepthSource> depth;
  const std::scoped_lock lock(mutex_);
  color_.swap(color);
  depth_.swap(depth);
}

void OpenSources::interrupt() noexcept {
  const std::scoped_lock lock(mutex_);
  interrupted_ = true;
  if (color_) color_->interrupt();
  if (depth_) depth_->interrupt();
}

bool OpenSources::interrupted() noexcept {
  const std::scoped_lock lock(mutex_);
  return interrupted_;
}

bool OpenSources::waitsForColor(const Clock* file_clock) noexcept {
  const std::scoped_lock lock(mutex_);
  const bool waits = color_ && color_->waitsForSource();
  if (file_clock == nullptr) return waits;
  const MonotonicTime now = file_clock->now();
  if (!waits) waits_since_.reset();
  else if (!waits_since_) waits_since_ = now;
  return waits && now >= *waits_since_ + kStall;
}

}  // namespace relievo
