// SPDX-License-Identifier: Apache-2.0
// A proxy on the triangulated relief: the proxy graph (Walker and Salisbury 2003), the paper's modified one, and a
// converged god-object, which differ in the parts that they are made of.
#pragma once

#include <cstdint>

#include "app/depth_window/parts.h"
#include "app/haptics/baseline/surface_in_time.h"
#include "app/haptics/method/method.h"

namespace relievo {

// The points where the proxy may rest.
enum class Walk : std::uint8_t {
  Graph,  // on edges and vertices
  Faces,  // anywhere: the true closest point of the triangles
};

struct TriangleParts {
  Walk walk = Walk::Graph;
  TimeLaw time = TimeLaw::Hold;
  // IV-A: a rising surface takes the proxy along. Without this, a surface that rises past the proxy between two ticks
  // is not noticed, and contact is lost until the finger has been outside (paper, Fig. 5).
  bool carry = false;
  // IV-C: if the force changes by more than this from one tick to the next, the proxy is let through; 0: never.
  double jump_threshold_n = 0;
};

class TriangleProxy final : public TouchMethod {
 public:
  // The paper gives no figure for its threshold. With this one its method passes the most scenarios (`relievo-lab
  // stability`, chart guard-sensitivity): lower ones take fast fingers and missed ticks for jumps of the scene.
  static constexpr double kJumpThresholdN = 8.0;

  TriangleProxy(double stiffness_n_per_mm, const TriangleParts& parts) noexcept
      : stiffness_(stiffness_n_per_mm), parts_(parts) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void reset() RELIEVO_RT override { primed_ = false; }

 private:
  [[nodiscard]] glm::dvec3 carriedProxy(const SurfaceInTime& surface) const RELIEVO_RT;

  double stiffness_;
  TriangleParts parts_;
  bool primed_ = false;
  std::uint32_t epoch_ = 0;
  Touch last_;
  double height_under_proxy_ = HeightField::kHole;  // of the surface at the proxy's x, y, in the tick before
};

// The step shared by these methods: moves the proxy from its position (at or above the surface) towards the finger
// until the surface stops it, then slides it to the closest point of the surface.
[[nodiscard]] Touch followFinger(const SurfaceInTime& surface, const glm::dvec3& proxy_mm, const glm::dvec3& hip_mm,
                                 double stiffness_n_per_mm, Walk walk) RELIEVO_RT;

// The paper's guard (IV-C): where the force changes by more than the threshold, the proxy is collocated with the
// finger, which passes through the surface: no force until it has been outside. 0: no guard.
[[nodiscard]] Touch letThroughAtJump(const Touch& touch, const glm::dvec3& force_before_n, double threshold_n,
                                     const glm::dvec3& hip_mm) RELIEVO_RT;

}  // namespace relievo
