// SPDX-License-Identifier: Apache-2.0
// Proxy blending (Ruspini 2003; paper, IV-B): one proxy on the old surface and one on the new; the felt proxy lies
// between them.
#pragma once

#include "app/haptics/baseline/surface_in_time.h"
#include "app/haptics/method/method.h"
#include "hal/media/media_time.h"

namespace relievo {

// A proxy graph finds each of the two proxies, on a frame that does not change. Over one frame period the blended proxy
// moves from the previous frame's proxy to the present frame's: smooth, and about one frame late. The method is meant
// for surfaces that deform a little: it does not notice a surface that rises past the proxy.
class ProxyBlend final : public TouchMethod {
 public:
  ProxyBlend(double stiffness_n_per_mm, double jump_threshold_n) noexcept
      : stiffness_(stiffness_n_per_mm), jump_threshold_n_(jump_threshold_n) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override;
  void reset() RELIEVO_RT override { primed_ = false; }

 private:
  double stiffness_;
  double jump_threshold_n_;
  bool primed_ = false;
  std::uint32_t epoch_ = 0;
  MediaTime present_;  // of the frame that is the new surface
  Touch on_old_, on_new_, last_;
};

}  // namespace relievo
