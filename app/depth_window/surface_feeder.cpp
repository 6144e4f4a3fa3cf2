// SPDX-License-Identifier: Apache-2.0
// Turns the decoder's frames into those of the window.
#include "app/depth_window/surface_feeder.h"

#include <algorithm>
#include <utility>

namespace relievo {

void SurfaceFeeder::beginEpoch() noexcept {
  frames_.clear();
  ++epoch_;
}

Result<bool> SurfaceFeeder::update(const Frame& present, std::span<const Frame> ahead, bool last,
                                   const ClockSample& clock, const Materials& materials,
                                   std::optional<MediaTime> felt) {
  bool changed = clock.media != clock_.media || clock.monotonic != clock_.monotonic || clock.rate != clock_.rate;
  clock_ = clock;
  if (present.empty()) {
    changed = changed || !frames_.frames().empty();
    frames_.clear();
    return changed;
  }

  changed = frames_.moveTo(std::min(felt.value_or(present.pts), present.pts)) || changed;
  changed = changed || !frames_.contains(present.pts);
  auto added = add(present, materials.present);
  if (added && !*added) {
    beginEpoch();
    added = add(present, materials.present);
  }
  if (!added) {
    frames_.clear();
    return std::unexpected(added.error());
  }
  const auto newest = frames_.frames().back().time;
  const bool ended = addAhead(ahead, materials.ahead) && last;
  changed = changed || frames_.frames().back().time != newest || ended != ended_;
  ended_ = ended;
  return changed;
}

bool SurfaceFeeder::hear(const Frame& depth, const Frame& material) {
  const auto held = frames_.frames();
  if (held.empty() || depth.empty() || depth.pts <= held.back().time || frames_.full()) return false;
  return add(depth, material).value_or(false);
}

bool SurfaceFeeder::addAhead(std::span<const Frame> ahead, std::span<const Frame> materials) {
  for (std::size_t i = 0; i < ahead.size(); ++i) {
    const Frame& depth = ahead[i];
    if (depth.empty()) return false;
    if (depth.pts <= frames_.frames().back().time) continue;
    if (frames_.full()) return false;
    const auto added = add(depth, i < materials.size() ? materials[i] : Frame{});
    if (!added || !*added) return false;  // reported when it becomes the present one
  }
  return true;
}

Result<bool> SurfaceFeeder::add(const Frame& depth, const Frame& material) {
  if (frames_.contains(depth.pts)) return true;
  const auto field = HeightField::make(depth, calibration_, volume_);
  if (!field) return std::unexpected(field.error());
  if (const auto held = frames_.frames(); !held.empty()) {
    const HeightField& other = held.back().field;
    if (other.cols() != field->cols() || other.rows() != field->rows()) return false;
  }
  TimedSurface surface{.field = *field, .time = depth.pts, .owner = depth.owner, .material = {}};
  if (!material.empty()) {
    if (auto map = MaterialMap::make(material, volume_)) surface.material = std::make_shared<const MaterialMap>(*map);
  }
  frames_.add(std::move(surface));
  return true;
}

void SurfaceFeeder::fill(SurfaceWindow& window) const {
  frames_.fill(window);
  window.epoch = epoch_;
  window.clock = clock_;
  window.ended = ended_;
  window.carried = carried_;
}

std::optional<MediaTime> SurfaceFeeder::frameAt(MediaTime now) const noexcept {
  const TimedSurface* const frame = frames_.at(now);
  return frame == nullptr ? std::nullopt : std::optional(frame->time);
}

}  // namespace relievo
