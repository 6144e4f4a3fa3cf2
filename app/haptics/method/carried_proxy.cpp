// SPDX-License-Identifier: Apache-2.0
#include "app/haptics/method/carried_proxy.h"

#include <glm/geometric.hpp>

#include "platform/prefetch.h"

namespace relievo {

RELIEVO_TICK_CODE bool CarriedProxy::sweptAway(FeltSurface& surface, const Contact& contact, const glm::dvec3& hip_mm,
                                               double lowered_mm) RELIEVO_RT {
  constexpr double kFurtherMm = 3, kCarriedMm = 0.5;
  const glm::dvec2 place(contact.x_mm, contact.y_mm);
  const double away = glm::distance(glm::dvec3(place, contact.surface.z - lowered_mm), hip_mm);
  const double carried = glm::distance(place, own_place_mm_);
  const bool by_finger = carried <= 2 * glm::distance(hip_mm, own_hip_mm_);
  if (away < 2 * kFurtherMm || by_finger || on_its_way_) {
    on_its_way_ = !contact.settled && (by_finger || on_its_way_);
    own_place_mm_ = place;
    own_hip_mm_ = hip_mm;
    return false;
  }
  if (carried < kCarriedMm) return false;
  const double up = surface.height(hip_mm.x, hip_mm.y) - lowered_mm - hip_mm.z;
  return up > 0 && away > up + kFurtherMm;
}

}  // namespace relievo
