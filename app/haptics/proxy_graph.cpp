// SPDX-License-Identifier: Apache-2.0
// Collision detection by the segment from the previous proxy to the finger, then the walk over the graph.
#include "app/haptics/proxy_graph.h"

#include <glm/geometric.hpp>

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

Touch letThroughAtJump(const Touch& touch, const glm::dvec3& force_before_n, double threshold_n,
                       const glm::dvec3& hip_mm) RELIEVO_RT {
  const bool jump = threshold_n > 0 && glm::length(touch.force_n - force_before_n) > threshold_n;
  return jump ? Touch{.proxy_mm = hip_mm} : touch;
}

Touch ProxyGraph::update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (!primed_ || window.epoch != epoch_) {
    primed_ = true;
    epoch_ = window.epoch;
    last_ = Touch{.proxy_mm = hip_mm};
  }
  const Touch touch = followFinger(SurfaceInTime(window, now, time_), last_.proxy_mm, hip_mm, stiffness_);
  last_ = letThroughAtJump(touch, last_.force_n, jump_threshold_n_, hip_mm);
  return last_;
}

}  // namespace relievo
