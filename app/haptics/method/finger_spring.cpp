// SPDX-License-Identifier: Apache-2.0
#include "app/haptics/method/finger_spring.h"

#include <glm/geometric.hpp>

#include "platform/prefetch.h"

namespace relievo {

RELIEVO_TICK_CODE glm::dvec3 FingerSpring::end(FeltSurface& surface, const PlaceMaterial& material,
                                               const Contact& closest, const glm::dvec3& hip_mm,
                                               double lowered_mm) RELIEVO_RT {
  glm::dvec3 place(closest.x_mm, closest.y_mm, closest.surface.z - lowered_mm);
  double depth = ripples_ ? glm::distance(place, hip_mm) : 0;
  if (rubs_) place = stick_.follow(surface, material.friction, closest, hip_mm, lowered_mm);
  if (softens_) {
    const double share = place_.share(glm::distance(place, hip_mm), material.stiffness_n_per_mm);
    if (share < 1) place = hip_mm + share * (place - hip_mm);
    depth *= share;
  }
  if (ripples_) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-closest.surface.zx, -closest.surface.zy, 1));
    place += ripple_.offset({hip_mm, normal, depth, material.amplitude_mm, material.stiffness_n_per_mm});
  }
  return place;
}

void FingerSpring::release(double most_n) RELIEVO_RT {
  place_.release(most_n);
  stick_.release();
  ripple_.release();
}

}  // namespace relievo
