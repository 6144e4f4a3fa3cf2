// SPDX-License-Identifier: Apache-2.0
// Finds the part of the surface that a point lies in, and the point of the screen plane that is shown there.
#include "drivers/window/scene_ray.h"

#include <algorithm>

namespace relievo {

std::optional<SceneRay> rayThrough(const SceneViews& views, double across, double down) noexcept {
  const auto part = std::ranges::find_if(views.views, [&](const SceneView& view) {
    return across >= view.left && across < view.right && down >= view.top && down < view.bottom;
  });
  if (part == views.views.end()) return std::nullopt;
  const double right = 2 * (across - part->left) / (part->right - part->left) - 1;
  const double up = 1 - 2 * (down - part->top) / (part->bottom - part->top);
  return SceneRay{.screen_mm = {right * part->half_width_mm, up * part->half_height_mm},
                  .eye_x_mm = part->eye_x_mm,
                  .screen_z_mm = views.screen_z_mm,
                  .viewing_distance_mm = views.viewing_distance_mm,
                  .depth_mm = views.depth_mm};
}

}  // namespace relievo
