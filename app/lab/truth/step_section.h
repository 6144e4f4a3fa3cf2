// SPDX-License-Identifier: Apache-2.0
// A step in section across its wall: the exact geometry of two floors, two edges and a wall.
#pragma once

#include <glm/vec2.hpp>

namespace relievo {

// Points are (q, z): q the distance in front of the wall, z the height. The solid is z < high behind the wall (q < 0)
// and z < low in front of it.
struct StepSection {
  double high_mm = 0, low_mm = 0;

  [[nodiscard]] bool inside(const glm::dvec2& point) const { return point.y < (point.x < 0 ? high_mm : low_mm); }
  // The place on floors and wall that is nearest to a point.
  [[nodiscard]] glm::dvec2 nearest(const glm::dvec2& point) const;
  // Where a proxy that lies on floors or wall comes to rest when it slides downhill in distance from `finger`, which
  // is inside the solid.
  [[nodiscard]] glm::dvec2 slide(const glm::dvec2& proxy, const glm::dvec2& finger) const;
};

}  // namespace relievo
