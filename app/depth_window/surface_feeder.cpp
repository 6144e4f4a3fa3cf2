// SPDX-License-Identifier: Apache-2.0
// Keeps the list of distinct depth frames in step with the picture that is shown.
#include "app/depth_window/surface_feeder.h"

#include <algorithm>

namespace relievo {

void SurfaceFeeder::beginEpoch() noexcept {
  frames_.clear();
  shots_.forget();
  ++epoch_;
}

Result<bool> SurfaceFeeder::update(const Frame& present, std::span<const Frame> ahead, bool last,
                                   const ClockSample& clock) {
  bool changed = clock.media != clock_.media || clock.monotonic != clock_.monotonic || clock.rate != clock_.rate;
  clock_ = clock;
  if (present.empty()) {
    changed = changed || !frames_.empty();
    frames_.clear();
    return changed;
  }

  // Of what is over, the newest two frames stay: a surface in time looks back by two.
  const auto now =
      std::find_if(frames_.begin(), frames_.end(), [&](const TimedSurface& f) { return f.time >= present.pts; });
  if (now - frames_.begin() > SurfaceWindow::kBefore) {
    frames_.erase(frames_.begin(), now - SurfaceWindow::kBefore);
    changed = true;
  }

  const std::size_t before = frames_.size();
  auto appended = append(present);
  if (appended && !*appended) {
    beginEpoch();
    appended = append(present);
  }
  if (!appended) {
    frames_.clear();
    return std::unexpected(appended.error());
  }
  const bool ended = appendAhead(present.pts, ahead) && last;
  if (frames_.size() != before) shots_.mark(frames_);
  changed = changed || frames_.size() != before || ended != ended_;
  ended_ = ended;
  return changed;
}

bool SurfaceFeeder::appendAhead(MediaTime present, std::span<const Frame> ahead) {
  auto count = std::count_if(frames_.begin(), frames_.end(), [&](const TimedSurface& f) { return f.time > present; });
  for (const Frame& depth : ahead) {
    if (depth.empty()) return false;
    if (depth.pts <= frames_.back().time) continue;
    if (count == kAhead) return false;
    const auto appended = append(depth);
    if (!appended || !*appended) return false;  // told when it becomes the present one
    ++count;
  }
  return true;
}

Result<bool> SurfaceFeeder::append(const Frame& depth) {
  if (!frames_.empty() && depth.pts <= frames_.back().time) return true;
  const auto field = HeightField::make(depth, calibration_, volume_);
  if (!field) return std::unexpected(field.error());
  if (!frames_.empty() &&
      (frames_.back().field.cols() != field->cols() || frames_.back().field.rows() != field->rows())) {
    return false;
  }
  frames_.push_back({*field, depth.pts, depth.owner});
  return true;
}

void SurfaceFeeder::fill(SurfaceWindow& window) const {
  std::size_t i = 0;
  for (; i < frames_.size() && i < window.frames.size(); ++i) window.frames[i] = frames_[i];
  window.count = static_cast<int>(i);
  for (; i < window.frames.size(); ++i) window.frames[i] = {};
  window.epoch = epoch_;
  window.clock = clock_;
  window.ended = ended_;
}

std::optional<MediaTime> SurfaceFeeder::frameAt(MediaTime now) const noexcept {
  if (frames_.empty()) return std::nullopt;
  const auto after = std::find_if(frames_.begin(), frames_.end(), [&](const TimedSurface& f) { return f.time > now; });
  return after == frames_.begin() ? frames_.front().time : (after - 1)->time;
}

}  // namespace relievo
