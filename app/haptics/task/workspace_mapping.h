// SPDX-License-Identifier: Apache-2.0
// From the device's workspace to the display volume: scale, clutch, and soft edges where the device ends.
#pragma once

#include <glm/vec3.hpp>

#include "app/scene/display_volume.h"
#include "hal/haptic_device.h"
#include "platform/realtime.h"

namespace relievo {

// The centres of workspace and volume are the same place until the clutch has moved them. Where the workspace is
// smaller than the picture, a device millimetre is more of the scene: as much as it takes to reach every place of the
// picture, and no more. A wall of K is then felt as one of scale x K.
class WorkspaceMapping {
 public:
  // Held, it lets the device go on while the finger stays: like lifting a mouse.
  static constexpr std::uint32_t kClutchButton = 1U << 1U;

  WorkspaceMapping() = default;
  WorkspaceMapping(const HapticCapabilities& device, const DisplayVolume& volume) noexcept;

  // Scene millimetres per device millimetre, 1 or more.
  [[nodiscard]] double scale() const noexcept { return scale_; }

  struct Finger {
    glm::dvec3 hip_mm{0};        // scene frame
    bool clutched = false;       // the finger feels nothing
    glm::dvec3 edge_force_n{0};  // on the hand, where the device nears the end of its workspace
  };
  // Once a tick.
  [[nodiscard]] Finger follow(const HapticSample& sample) RELIEVO_RT;
  // The device's position for a place of the scene, as the mapping is now.
  [[nodiscard]] glm::dvec3 deviceAt(const glm::dvec3& scene_mm) const noexcept {
    return (scene_mm - offset_mm_) / scale_;
  }

 private:
  double scale_ = 1;
  glm::dvec3 offset_mm_{0};  // scene = scale x device + offset
  glm::dvec3 min_mm_{0}, max_mm_{0};
  glm::dvec3 held_mm_{0};  // scene frame; where the finger is while clutched
  bool clutched_ = false;
};

}  // namespace relievo
