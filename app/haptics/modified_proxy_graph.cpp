// SPDX-License-Identifier: Apache-2.0
// The paper's three corrections around the proxy graph's step.
#include "app/haptics/modified_proxy_graph.h"

#include <glm/geometric.hpp>

#include "app/haptics/proxy_graph.h"

namespace relievo {

Touch ModifiedProxyGraph::update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (!primed_ || window.epoch != epoch_) {
    primed_ = true;
    epoch_ = window.epoch;
    proxy_ = hip_mm;
    force_ = glm::dvec3(0);
    height_under_proxy_ = HeightField::kHole;
  }
  const SurfaceInTime surface(window, now, time_);  // IV-B
  Touch touch = followFinger(surface, carriedProxy(surface), hip_mm, stiffness_);
  if (jump_threshold_n_ > 0 && glm::length(touch.force_n - force_) > jump_threshold_n_) {
    // IV-C: the force changed abruptly, so the proxy is collocated with the finger and passes through the surface.
    touch = Touch{.proxy_mm = hip_mm};
  }
  proxy_ = touch.proxy_mm;
  force_ = touch.force_n;
  height_under_proxy_ = surfaceHeight(surface, proxy_.x, proxy_.y);
  return touch;
}

// IV-A: where the surface has risen under the proxy, the proxy has risen by as much before collisions are looked for.
// Both heights are taken at the proxy's own place, so the surface can never come up past it. A hole in either tick
// compares false: no carry.
glm::dvec3 ModifiedProxyGraph::carriedProxy(const SurfaceInTime& surface) const RELIEVO_RT {
  const double risen = surfaceHeight(surface, proxy_.x, proxy_.y) - height_under_proxy_;
  return risen > 0 ? glm::dvec3(proxy_.x, proxy_.y, proxy_.z + risen) : proxy_;
}

}  // namespace relievo
