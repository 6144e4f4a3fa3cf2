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
  // `jump_threshold_n` 0: none.
  ProxyGraph(double stiffness_n_per_mm, TimeLaw time, double jump_threshold_n) noexcept
      : stiffness_(stiffness_n_per_mm), time_(time), jump_threshold_n_(jump_threshold_n) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void reset() RELIEVO_RT override { primed_ = false; }

 private:
  double stiffness_;
  TimeLaw time_;
  double jump_threshold_n_;
  bool primed_ = false;
  std::uint32_t epoch_ = 0;
  Touch last_;
};

// The step that all proxy graph methods share: from where the proxy was (at or above the surface) towards the finger,
// stopped by the surface and slid to the closest point on it.
[[nodiscard]] Touch followFinger(const SurfaceInTime& surface, const glm::dvec3& proxy_mm, const glm::dvec3& hip_mm,
                                 double stiffness_n_per_mm) RELIEVO_RT;

// The paper's guard (IV-C): where the force changes by more than the threshold from one tick to the next, the proxy is
// collocated with the finger, which passes through the surface: no force until it has been outside. 0: no guard.
[[nodiscard]] Touch letThroughAtJump(const Touch& touch, const glm::dvec3& force_before_n, double threshold_n,
                                     const glm::dvec3& hip_mm) RELIEVO_RT;

}  // namespace relievo
