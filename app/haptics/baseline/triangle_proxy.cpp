// SPDX-License-Identifier: Apache-2.0
// Collision detection by the segment from the previous proxy to the finger, then the walk; and the paper's corrections.
#include "app/haptics/baseline/triangle_proxy.h"

#include <glm/geometric.hpp>

#include "app/haptics/baseline/face_walk.h"
#include "app/haptics/baseline/graph_walk.h"
#include "app/haptics/baseline/segment_search.h"

namespace relievo {
namespace {

// The proxy rests on the surface but for rounding; the segment starts this much above it, mm.
constexpr double kLiftMm = 1e-6;

}  // namespace

Touch followFinger(const SurfaceInTime& surface, const glm::dvec3& proxy_mm, const glm::dvec3& hip_mm,
                   double stiffness_n_per_mm, Walk walk) RELIEVO_RT {
  Touch touch{.proxy_mm = hip_mm};
  if (surface.empty() ||
      !GridTriangle::under(surface.grid().u(hip_mm.x), surface.grid().v(hip_mm.y), surface.cols(), surface.rows())) {
    return touch;  // there is no surface over a finger outside the grid, whatever the proxy last rested on
  }
  const glm::dvec3 start(proxy_mm.x, proxy_mm.y, proxy_mm.z + kLiftMm);
  const auto crossing = firstCrossing(surface, start, hip_mm);
  if (!crossing) return touch;
  touch.contact = true;
  touch.proxy_mm =
      walk == Walk::Graph ? walkToClosest(surface, *crossing, hip_mm) : walkFacesToClosest(surface, *crossing, hip_mm);
  touch.force_n = stiffness_n_per_mm * (touch.proxy_mm - hip_mm);
  return touch;
}

Touch letThroughAtJump(const Touch& touch, const glm::dvec3& force_before_n, double threshold_n,
                       const glm::dvec3& hip_mm) RELIEVO_RT {
  const bool jump = threshold_n > 0 && glm::length(touch.force_n - force_before_n) > threshold_n;
  return jump ? Touch{.proxy_mm = hip_mm} : touch;
}

Touch TriangleProxy::update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (!primed_ || window.epoch != epoch_) {
    primed_ = true;
    epoch_ = window.epoch;
    last_ = Touch{.proxy_mm = hip_mm};
    height_under_proxy_ = HeightField::kHole;
  }
  const Cuts cuts = parts_.walk == Walk::Graph ? Cuts::Unknown : Cuts::Heeded;
  const SurfaceInTime surface(window, now, parts_.time, cuts);
  const Touch touch = followFinger(surface, carriedProxy(surface), hip_mm, stiffness_, parts_.walk);
  last_ = letThroughAtJump(touch, last_.force_n, parts_.jump_threshold_n, hip_mm);
  if (parts_.carry) height_under_proxy_ = surfaceHeight(surface, last_.proxy_mm.x, last_.proxy_mm.y);
  return last_;
}

// Where the surface has risen under the proxy, the proxy has risen by as much before collisions are looked for. Both
// heights are taken at the proxy's own place, so the surface can never come up past it. A hole in either tick compares
// false: no carry.
glm::dvec3 TriangleProxy::carriedProxy(const SurfaceInTime& surface) const RELIEVO_RT {
  const glm::dvec3& proxy = last_.proxy_mm;
  if (!parts_.carry) return proxy;
  const double risen = surfaceHeight(surface, proxy.x, proxy.y) - height_under_proxy_;
  return risen > 0 ? proxy + glm::dvec3(0, 0, risen) : proxy;
}

}  // namespace relievo
