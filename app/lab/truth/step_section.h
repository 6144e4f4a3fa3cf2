// SPDX-License-Identifier: Apache-2.0
// A step in section across its wall: exact geometry of two floors, two edges and a wall.
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
  // The place where a proxy on floors or wall comes to rest if it slides so that its distance to `finger`, which is
  // inside the solid, falls.
  [[nodiscard]] glm::dvec2 slide(const glm::dvec2& proxy, const glm::dvec2& finger) const;
};

}  // namespace relievo
