// SPDX-License-Identifier: Apache-2.0
// The nearest places on a bent line, in closed form.
#include "app/lab/truth/step_section.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

namespace relievo {

glm::dvec2 StepSection::nearest(const glm::dvec2& point) const {
  const std::array<glm::dvec2, 3> feet{{{std::min(point.x, 0.0), high_mm},
                                        {0.0, std::clamp(point.y, low_mm, high_mm)},
                                        {std::max(point.x, 0.0), low_mm}}};
  return *std::min_element(feet.begin(), feet.end(), [&](const glm::dvec2& a, const glm::dvec2& b) {
    return glm::distance(a, point) < glm::distance(b, point);
  });
}

glm::dvec2 StepSection::slide(const glm::dvec2& proxy, const glm::dvec2& finger) const {
  const bool on_high_floor = proxy.y >= high_mm;
  if (on_high_floor && finger.x <= 0) return {finger.x, high_mm};
  // Wall and low floor have one minimum between them. A finger that has passed below the edge is inside only below the
  // low floor: there the proxy falls from the edge all the way.
  if (finger.x < 0) return {0.0, std::clamp(finger.y, low_mm, high_mm)};
  return {finger.x, low_mm};
}

}  // namespace relievo
