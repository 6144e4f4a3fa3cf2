// SPDX-License-Identifier: Apache-2.0
// Tells whether the scene has carried the proxy away from its finger.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/haptics/method/closest_point.h"
#include "app/haptics/method/felt_surface.h"
#include "platform/realtime.h"

namespace relievo {

// Follows whether the finger's own motion explains the proxy's.
class CarriedProxy {
 public:
  // Call in each tick of contact, after the proxy has slid to `contact`; the felt surface lies `lowered_mm` below the
  // stored one. True if a moving wall has passed over the finger and carried the proxy along, although by now the way
  // straight up is much shorter. True only if the scene moved. A finger that pushes itself deep into a wall stays at
  // that wall, even if it rests there, is read only in every other tick, or leaps farther in one tick than the search
  // follows: the proxy then still moves towards the place to which the finger has sent it.
  [[nodiscard]] bool sweptAway(FeltSurface& surface, const Contact& contact, const glm::dvec3& hip_mm,
                               double lowered_mm) RELIEVO_RT;
  // Call when there is no contact.
  void release() RELIEVO_RT { on_its_way_ = false; }

 private:
  // Proxy and finger positions when the finger's motion last explained the proxy's.
  glm::dvec2 own_place_mm_{0};
  glm::dvec3 own_hip_mm_{0};
  bool on_its_way_ = false;  // the proxy has not yet reached the place where the finger sent it
};

}  // namespace relievo
