// SPDX-License-Identifier: Apache-2.0
// One triangle a tick.
#include "app/haptics/baseline/penalty.h"

#include <glm/geometric.hpp>

namespace relievo {

Touch Penalty::update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  Touch touch{.proxy_mm = hip_mm};
  const SurfaceInTime surface(window, now, time_);
  if (surface.empty()) return touch;
  const GridMapping& grid = surface.grid();
  const double u = grid.u(hip_mm.x), v = grid.v(hip_mm.y);
  const auto triangle = GridTriangle::under(u, v, surface.cols(), surface.rows());
  if (!triangle) return touch;
  const TrianglePlane plane(surface, *triangle);
  const double below = plane.at(u - triangle->c, v - triangle->r) - hip_mm.z;
  if (!(below > 0)) return touch;  // NaN over a hole
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-plane.zu * grid.u_per_mm, -plane.zv * grid.v_per_mm, 1));
  touch.contact = true;
  touch.proxy_mm = hip_mm + below * normal.z * normal;
  touch.force_n = stiffness_ * (touch.proxy_mm - hip_mm);
  return touch;
}

}  // namespace relievo
