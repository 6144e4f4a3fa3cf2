// SPDX-License-Identifier: Apache-2.0
// The line of sight through a point of a window's surface.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "hal/display.h"
#include "platform/realtime.h"

namespace relievo {

// The ray from an eye through a point of the screen plane, in the scene frame.
struct SceneRay {
  glm::dvec2 screen_mm{0};  // where it meets the screen plane
  double eye_x_mm = 0;
  double screen_z_mm = 0;
  double viewing_distance_mm = 1;
  double depth_mm = 0;  // of the display volume

  // The point of the ray at the height `z_mm`.
  [[nodiscard]] glm::dvec2 at(double z_mm) const RELIEVO_RT {
    const glm::dvec2 eye(eye_x_mm, 0);
    return eye + (1 - (z_mm - screen_z_mm) / viewing_distance_mm) * (screen_mm - eye);
  }
  bool operator==(const SceneRay&) const = default;
};

// `across`, `down`: shares of the surface's width and height, from its top left. Nullopt where no eye sees the scene.
[[nodiscard]] std::optional<SceneRay> rayThrough(const SceneViews& views, double across, double down) noexcept;

}  // namespace relievo
