// SPDX-License-Identifier: Apache-2.0
// The proxy graph algorithm (Walker and Salisbury 2003; paper, III) on the newest frame as it is.
#pragma once

#include "app/haptics/method.h"
#include "app/haptics/methods.h"
#include "app/haptics/surface_in_time.h"

namespace relievo {

// Made for a still height map: a surface that rises past the proxy between two ticks is not noticed, and the contact is
// lost until the finger has been outside (paper, Fig. 5). That is the method, not a mistake here.
class ProxyGraph final : public TouchMethod {
 public:
  ProxyGraph(double stiffness_n_per_mm, TimeLaw time) noexcept : stiffness_(stiffness_n_per_mm), time_(time) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void reset() RELIEVO_RT override { primed_ = false; }

 private:
  double stiffness_;
  TimeLaw time_;
  bool primed_ = false;
  std::uint32_t epoch_ = 0;
  glm::dvec3 proxy_{0};
};

// The step that all proxy graph methods share: from where the proxy was (at or above the surface) towards the finger,
// stopped by the surface and slid to the closest point on it.
[[nodiscard]] Touch followFinger(const SurfaceInTime& surface, const glm::dvec3& proxy_mm, const glm::dvec3& hip_mm,
                                 double stiffness_n_per_mm) RELIEVO_RT;

}  // namespace relievo
