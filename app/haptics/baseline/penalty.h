// SPDX-License-Identifier: Apache-2.0
// The penalty method: force = stiffness times the depth below the surface, along its normal. No proxy, no memory.
#pragma once

#include "app/depth_window/parts.h"
#include "app/haptics/baseline/surface_in_time.h"
#include "app/haptics/method/method.h"

namespace relievo {

// The surface is the triangle straight above the finger, and the depth is the distance to its plane. When the finger
// moves below another triangle, the force turns with it: a thin part pushes the finger out on the wrong side.
class Penalty final : public TouchMethod {
 public:
  Penalty(double stiffness_n_per_mm, TimeLaw time) noexcept : stiffness_(stiffness_n_per_mm), time_(time) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void reset() RELIEVO_RT override {}

 private:
  double stiffness_;
  TimeLaw time_;
};

}  // namespace relievo
