// SPDX-License-Identifier: Apache-2.0
#include "app/haptics/task/workspace_mapping.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace relievo {
namespace {

constexpr double kEdgeMm = 4;                 // width of the soft margin of the workspace, device frame
constexpr double kEdgeStiffnessNPerMm = 0.2;  // reaches 0.8 N at the device's own stop

}  // namespace

WorkspaceMapping::WorkspaceMapping(const HapticCapabilities& device, const DisplayVolume& volume) noexcept
    : min_mm_(device.workspace_min_mm), max_mm_(device.workspace_max_mm), in_scene_(device.in_scene) {
  if (in_scene_) return;
  const glm::dvec3 room = max_mm_ - min_mm_ - glm::dvec3(2 * kEdgeMm);
  scale_ = std::max({1.0, volume.width_mm / room.x, volume.height_mm / room.y, volume.depth_mm / room.z});
  offset_mm_ = glm::dvec3(0, 0, 0.5 * volume.depth_mm) - scale_ * 0.5 * (min_mm_ + max_mm_);
}

WorkspaceMapping::Finger WorkspaceMapping::follow(const HapticSample& sample) RELIEVO_RT {
  if (in_scene_) return {.hip_mm = sample.position_mm};
  const glm::dvec3& p_mm = sample.position_mm;
  if (!std::isfinite(glm::dot(p_mm, p_mm))) return {.hip_mm = p_mm, .clutched = clutched_};  // spoils no later tick
  const glm::dvec3 hip_mm = scale_ * sample.position_mm + offset_mm_;
  const bool pressed = (sample.buttons & kClutchButton) != 0;
  if (pressed && !clutched_) held_mm_ = hip_mm;
  if (pressed) offset_mm_ += held_mm_ - hip_mm;
  clutched_ = pressed;

  Finger finger{.hip_mm = pressed ? held_mm_ : hip_mm, .clutched = pressed};
  for (int axis = 0; axis < 3; ++axis) {
    const double p = sample.position_mm[axis];
    const double low = min_mm_[axis] + kEdgeMm - p, high = p - (max_mm_[axis] - kEdgeMm);
    // Beyond the margin the force stays constant.
    if (low > 0) finger.edge_force_n[axis] = kEdgeStiffnessNPerMm * std::min(low, kEdgeMm);
    if (high > 0) finger.edge_force_n[axis] = -kEdgeStiffnessNPerMm * std::min(high, kEdgeMm);
  }
  return finger;
}

}  // namespace relievo
