// SPDX-License-Identifier: Apache-2.0
// The order of the limits: finite, magnitude, then the rate at which the scene may act.
#include "app/haptics/safety.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace relievo {

glm::dvec3 SafetyFilter::apply(const glm::dvec3& wanted_n, double moved_mm, double elapsed_s) RELIEVO_RT {
  glm::dvec3 target = wanted_n;
  double size = glm::length(target);
  if (!std::isfinite(size)) {
    target = glm::dvec3(0);
    size = 0;
  }
  if (size > limits_.force_n) target *= limits_.force_n / size;

  const double by_hand = std::isfinite(moved_mm) ? stiffness_ * moved_mm : 0.0;
  const double elapsed = std::clamp(elapsed_s, 0.0, 0.1);
  const glm::dvec3 change = target - sent_n_;
  const double wished = glm::length(change);
  const double allowed = by_hand + limits_.scene_slew_n_per_s * elapsed;
  if (wished > allowed) target = sent_n_ + change * (allowed / wished);

  const double beyond_hand = std::max(glm::length(target - sent_n_) - by_hand, 0.0);
  scene_slew_ = elapsed > 0 ? beyond_hand / elapsed : 0.0;
  sent_n_ = target;
  return target;
}

}  // namespace relievo
