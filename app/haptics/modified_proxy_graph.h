// SPDX-License-Identifier: Apache-2.0
// The paper's modified proxy graph algorithm: carried up by a rising surface, between frames, let through at a jump.
#pragma once

#include "app/haptics/method.h"
#include "app/haptics/methods.h"
#include "app/haptics/surface_in_time.h"

namespace relievo {

class ModifiedProxyGraph final : public TouchMethod {
 public:
  // The paper names no figure for its threshold (IV-C). This one is a finger that comes in at 2 m/s on the default
  // stiffness: a faster change than that is taken for the scene's.
  static constexpr double kJumpThresholdN = 1.0;

  // `jump_threshold_n` 0: none.
  ModifiedProxyGraph(double stiffness_n_per_mm, TimeLaw time, double jump_threshold_n) noexcept
      : stiffness_(stiffness_n_per_mm), time_(time), jump_threshold_n_(jump_threshold_n) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void reset() RELIEVO_RT override { primed_ = false; }

 private:
  [[nodiscard]] glm::dvec3 carriedProxy(const SurfaceInTime& surface) const RELIEVO_RT;

  double stiffness_;
  TimeLaw time_;
  double jump_threshold_n_;
  bool primed_ = false;
  std::uint32_t epoch_ = 0;
  Touch last_;
  double height_under_proxy_ = HeightField::kHole;  // of the surface at the proxy's x, y, in the tick before
};

}  // namespace relievo
