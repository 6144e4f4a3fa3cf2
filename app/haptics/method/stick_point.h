// SPDX-License-Identifier: Apache-2.0
// Friction: the point of the surface that holds the finger until the finger pulls too far aside.
#pragma once

#include <glm/vec3.hpp>

#include "app/haptics/method/closest_point.h"
#include "app/haptics/method/felt_surface.h"
#include "app/scene/material.h"
#include "platform/realtime.h"

namespace relievo {

// The spring goes from the finger to a point of the surface other than the closest one (the friction cone of Harwin and
// Melder 2002). The point rests while the spring's force lies within the cone of the static coefficient around the
// surface's normal there; beyond it the point slides towards the closest one, until the force lies on the cone of the
// dynamic coefficient. If the closest point moves to another side of the solid, so does this point. A spring to a
// resting point returns no more energy than it has taken, and each slide makes it shorter, so friction only takes
// energy.
//
// The tick itself does not read the surface at the point: `prepare` has read it there after the last force, and between
// the point and the closest one the surface is taken as the cubic through both ends' heights and slopes. A point that
// slides farther than the size of the surface's features is put onto the surface at once, any other in the next tick.
//
// A point that has just moved is held by the dynamic coefficient, and by the static one after kSettleS of rest (as in
// friction that ages, Dieterich 1979): without this delay, a sensor's noise makes a sliding finger stick again and
// again.
class StickPoint {
 public:
  static constexpr double kSettleS = 0.1;

  explicit StickPoint(double tick_s) noexcept : tick_s_(tick_s) {}

  // The point that holds the finger in this tick of contact; scene mm. `closest` is the closest point of the surface,
  // which lies `lowered_mm` below the stored one.
  [[nodiscard]] glm::dvec3 follow(FeltSurface& surface, const Friction& friction, const Contact& closest,
                                  const glm::dvec3& hip_mm, double lowered_mm) RELIEVO_RT;
  // Reads the surface at the point; `surface` is at the next tick's moment.
  void prepare(FeltSurface& surface) RELIEVO_RT;
  // Call when contact ends or begins anew.
  void release() RELIEVO_RT { holds_ = prepared_ = false; }

  [[nodiscard]] bool holds() const RELIEVO_RT { return holds_; }
  // True while the point slides, and until it has rested for kSettleS.
  [[nodiscard]] bool slides() const RELIEVO_RT { return holds_ && rested_s_ < kSettleS; }

 private:
  double tick_s_;
  bool holds_ = false, prepared_ = false;
  Contact at_;  // its surface is that of the next tick if it is prepared
  double rested_s_ = 0;
};

}  // namespace relievo
