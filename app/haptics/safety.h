// SPDX-License-Identifier: Apache-2.0
// What every force passes, whatever the method says: finite, limited, never switched in, the scene slowed down.
#pragma once

#include <glm/vec3.hpp>

#include "platform/realtime.h"

namespace relievo {

struct SafetyLimits {
  double force_n = 10.0;             // and never above the device's peak
  double scene_slew_n_per_s = 50.0;  // how fast the scene may change the force
};

// The hand may change the force as fast as it likes, the scene at a limited rate. Which of the two it was is told by
// the spring: a hand that moves by dx over a still surface changes a spring's force by at most stiffness x |dx| (the
// closest point on a convex solid moves no further than the finger). What a tick changes beyond that is the scene's,
// and is let through at the slew limit; the rest follows in the next ticks.
class SafetyFilter {
 public:
  SafetyFilter() = default;
  SafetyFilter(const SafetyLimits& limits, double stiffness_n_per_mm) noexcept
      : limits_(limits), stiffness_(stiffness_n_per_mm) {}

  // The force to send, given what the method asks for. `moved_mm`: how far the finger came since the last tick;
  // `elapsed_s`: since the last tick. Starts from zero after `reset`.
  [[nodiscard]] glm::dvec3 apply(const glm::dvec3& wanted_n, double moved_mm, double elapsed_s) RELIEVO_RT;
  void reset() RELIEVO_RT { sent_n_ = glm::dvec3(0); }

  // How fast the scene changed the force in the last `apply`: (|change| - stiffness x moved)/elapsed, at least 0.
  [[nodiscard]] double sceneSlew() const RELIEVO_RT { return scene_slew_; }

 private:
  SafetyLimits limits_;
  double stiffness_ = 0;
  glm::dvec3 sent_n_{0};
  double scene_slew_ = 0;
};

}  // namespace relievo
