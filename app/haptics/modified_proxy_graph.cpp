// SPDX-License-Identifier: Apache-2.0
// The paper's three corrections around the proxy graph's step.
#include "app/haptics/modified_proxy_graph.h"

#include "app/haptics/proxy_graph.h"

namespace relievo {

Touch ModifiedProxyGraph::update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (!primed_ || window.epoch != epoch_) {
    primed_ = true;
    epoch_ = window.epoch;
    last_ = Touch{.proxy_mm = hip_mm};
    height_under_proxy_ = HeightField::kHole;
  }
  const SurfaceInTime surface(window, now, time_);  // IV-B
  const Touch touch = followFinger(surface, carriedProxy(surface), hip_mm, stiffness_);
  last_ = letThroughAtJump(touch, last_.force_n, jump_threshold_n_, hip_mm);  // IV-C
  height_under_proxy_ = surfaceHeight(surface, last_.proxy_mm.x, last_.proxy_mm.y);
  return last_;
}

// IV-A: where the surface has risen under the proxy, the proxy has risen by as much before collisions are looked for.
// Both heights are taken at the proxy's own place, so the surface can never come up past it. A hole in either tick
// compares false: no carry.
glm::dvec3 ModifiedProxyGraph::carriedProxy(const SurfaceInTime& surface) const RELIEVO_RT {
  const glm::dvec3& proxy = last_.proxy_mm;
  const double risen = surfaceHeight(surface, proxy.x, proxy.y) - height_under_proxy_;
  return risen > 0 ? proxy + glm::dvec3(0, 0, risen) : proxy;
}

}  // namespace relievo
