// SPDX-License-Identifier: Apache-2.0
// What every force passes, whatever the method says: finite, limited, never switched in, the scene slowed down, and no
// energy out of sampling.
#pragma once

#include <glm/vec3.hpp>

#include "app/haptics/task/energy_books.h"
#include "platform/realtime.h"

namespace relievo {

struct SafetyLimits {
  double force_n = 10.0;             // and never above the device's peak
  double scene_slew_n_per_s = 50.0;  // how fast the scene may change the force
  bool limit_energy = true;          // of the artefacts of sampling
};

// The hand may change the force as fast as it likes, the scene at a limited rate. Which of the two it was is told by
// the spring: a hand that moves by dx over a still surface changes a spring's force by at most stiffness x |dx| (the
// closest point on a convex solid moves no further than the finger). What a tick changes beyond that is the scene's,
// and is let through at the slew limit; the rest follows in the next ticks. That bounds the scene's power as well: a
// spring whose force changes by 50 N/s gives force x 50 N/s / stiffness.
//
// A force that is held for a tick does stiffness x dx^2/2 of work too much, in and out (see EnergyBooks). Where the
// book of these artefacts would go above zero, the force is leant against the finger's motion by as much as takes it
// back in the tick to come, and never by more than stiffness x |dx|: a damping, not a kick (after the passivity
// controller of Hannaford and Ryu 2002, with the scene's own work left out of the book). Where the device has a new
// position in every other tick only, dx is the way from one to the next, and the force leans until the next is overdue.
class SafetyFilter {
 public:
  SafetyFilter() = default;
  SafetyFilter(const SafetyLimits& limits, double stiffness_n_per_mm) noexcept
      : limits_(limits), stiffness_(stiffness_n_per_mm), books_(stiffness_n_per_mm) {}

  // The force to send, given what the method asks for. `device_mm`: where the handle is, in the
  // device's frame, as the forces are; `elapsed_s`: since the last
  // tick. Starts from zero after `reset`.
  [[nodiscard]] glm::dvec3 apply(const glm::dvec3& wanted_n, const glm::dvec3& device_mm, double elapsed_s) RELIEVO_RT;
  void reset() RELIEVO_RT;

  // How fast the scene changed the force in the last `apply`: (|change| - stiffness x moved)/elapsed, at least 0.
  [[nodiscard]] double sceneSlew() const RELIEVO_RT { return scene_slew_; }
  // Since construction.
  [[nodiscard]] const EnergyBooks& books() const RELIEVO_RT { return books_; }

 private:
  void lean(const glm::dvec3& spring_n, const glm::dvec3& moved_mm, double elapsed_s) RELIEVO_RT;

  SafetyLimits limits_;
  double stiffness_ = 0;
  EnergyBooks books_;
  bool primed_ = false;  // there was a tick before this one
  glm::dvec3 last_device_mm_{0};
  glm::dvec3 spring_n_{0};  // limited in all but the artefacts' energy
  glm::dvec3 sent_n_{0};
  glm::dvec3 lean_n_{0};
  double since_moved_s_ = 0, pace_s_ = 0;  // since the last new position; from the one before to that
  double scene_slew_ = 0;
};

}  // namespace relievo
