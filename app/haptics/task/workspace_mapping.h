// SPDX-License-Identifier: Apache-2.0
// Maps the device's workspace to the display volume: scale, clutch, and soft edges at the workspace's ends.
#pragma once

#include <glm/vec3.hpp>

#include "app/scene/display_volume.h"
#include "hal/haptic_device.h"
#include "platform/realtime.h"

namespace relievo {

// The centres of workspace and volume coincide until the clutch moves them. If the workspace is smaller than the
// picture, one device millimetre maps to more scene millimetres, just enough to reach the whole picture. A wall of
// stiffness K is then felt as scale x K. A device that points at the picture is mapped one to one.
class WorkspaceMapping {
 public:
  // While held, the device moves and the finger stays, as when a mouse is lifted.
  static constexpr std::uint32_t kClutchButton = 1U << 1U;

  WorkspaceMapping() = default;
  WorkspaceMapping(const HapticCapabilities& device, const DisplayVolume& volume) noexcept;

  // Scene millimetres per device millimetre, at least 1.
  [[nodiscard]] double scale() const noexcept { return scale_; }

  struct Finger {
    glm::dvec3 hip_mm{0};        // scene frame
    bool clutched = false;       // the finger feels nothing
    glm::dvec3 edge_force_n{0};  // on the hand, near the ends of the device's workspace
  };
  // Call once a tick.
  [[nodiscard]] Finger follow(const HapticSample& sample) RELIEVO_RT;
  // The device position of a point of the scene under the current mapping.
  [[nodiscard]] glm::dvec3 deviceAt(const glm::dvec3& scene_mm) const noexcept {
    return (scene_mm - offset_mm_) / scale_;
  }

 private:
  double scale_ = 1;
  glm::dvec3 offset_mm_{0};  // scene = scale x device + offset
  glm::dvec3 min_mm_{0}, max_mm_{0};
  glm::dvec3 held_mm_{0};  // scene frame; the finger's position while clutched
  bool clutched_ = false;
  bool in_scene_ = false;
};

}  // namespace relievo
