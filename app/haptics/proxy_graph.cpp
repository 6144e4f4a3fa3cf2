// SPDX-License-Identifier: Apache-2.0
// Collision detection by the segment from the previous proxy to the finger, then the walk over the graph.
#include "app/haptics/proxy_graph.h"

#include "app/haptics/graph_walk.h"
#include "app/haptics/segment_search.h"

namespace relievo {
namespace {

// The proxy rests on the surface but for rounding; the segment starts this much above it, mm.
constexpr double kLiftMm = 1e-6;

}  // namespace

Touch followFinger(const SurfaceInTime& surface, const glm::dvec3& proxy_mm, const glm::dvec3& hip_mm,
                   double stiffness_n_per_mm) RELIEVO_RT {
  Touch touch{.proxy_mm = hip_mm};
  if (surface.empty() ||
      !GridTriangle::under(surface.grid().u(hip_mm.x), surface.grid().v(hip_mm.y), surface.cols(), surface.rows())) {
    return touch;  // there is no surface over a finger outside the grid, whatever the proxy last rested on
  }
  const glm::dvec3 start(proxy_mm.x, proxy_mm.y, proxy_mm.z + kLiftMm);
  const auto crossing = firstCrossing(surface, start, hip_mm);
  if (!crossing) return touch;
  touch.contact = true;
  touch.proxy_mm = walkToClosest(surface, *crossing, hip_mm);
  touch.force_n = stiffness_n_per_mm * (touch.proxy_mm - hip_mm);
  return touch;
}

Touch ProxyGraph::update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (!primed_ || window.epoch != epoch_) {
    primed_ = true;
    epoch_ = window.epoch;
    proxy_ = hip_mm;
  }
  const Touch touch = followFinger(SurfaceInTime(window, now, time_), proxy_, hip_mm, stiffness_);
  proxy_ = touch.proxy_mm;
  return touch;
}

}  // namespace relievo
