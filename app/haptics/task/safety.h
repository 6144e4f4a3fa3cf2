// SPDX-License-Identifier: Apache-2.0
// Limits on every force, whatever the method computes: finite, bounded, faded in, slow changes by the scene, no energy
// from sampling.
#pragma once

#include <glm/vec3.hpp>

#include "app/haptics/task/energy_books.h"
#include "platform/realtime.h"

namespace relievo {

struct SafetyLimits {
  double force_n = 10.0;             // never above the device's peak
  double scene_slew_n_per_s = 50.0;  // largest rate at which the scene may change the force
  bool limit_energy = true;          // remove the energy that sampling adds
  double tank_mj = 20.0;             // work of a force that lags behind the scene, at once
  double tank_mj_per_s = 10.0;       // and in the long run
};

// The hand may change the force at any rate, the scene only at a limited rate. The spring separates the two: a hand
// that moves by dx over a still surface changes a spring's force by at most stiffness x |dx| (the closest point on a
// convex solid moves no further than the finger). Any larger change in a tick is due to the scene and passes at the
// slew limit; the rest follows in later ticks. This bounds the scene's power too: a spring whose force changes by 50
// N/s delivers force x 50 N/s / stiffness.
//
// A force held for a tick does stiffness x dx^2/2 too much work, both inwards and outwards (see EnergyBooks). If the
// book of these artefacts would rise above zero, the force is tilted against the finger's motion by as much as recovers
// the energy in the next tick, and never by more than stiffness x |dx|: damping, not a kick (after the passivity
// controller of Hannaford and Ryu 2002, with the scene's own work excluded from the book). If the device has a new
// position only in every other tick, dx is the movement between positions, and the force stays tilted until the next
// position is overdue.
//
// After a surface has leapt, the force lags and pushes on when the surface has already gone: up to force^2/(2 slew) x
// the hand's speed, 4 mJ for 2 N at 0.1 m/s. A cut costs that once; depth that leaps in every frame would pump energy.
// A tank (after Franken et al. 2011) pays for the lag's work: it is refilled slowly, and when less than half is left,
// the method's force fades with the rest. So a lag gives at most twice tank_mj, plus tank_mj_per_s x t. A finger that
// goes over a still step at 0.5 m/s again and again pays less than 10 mJ/s (energy-loop of relievo-lab stability).
class SafetyFilter {
 public:
  SafetyFilter() = default;
  SafetyFilter(const SafetyLimits& limits, double stiffness_n_per_mm) noexcept
      : limits_(limits), stiffness_(stiffness_n_per_mm), books_(stiffness_n_per_mm) {}

  // The force to send for the force that the method wants; `edge_n` is that of the soft ends of the device's workspace,
  // which the tank does not fade. `device_mm` is the handle's position in the device's frame, as are the forces;
  // `elapsed_s` is the time since the last tick. Starts from zero after `reset`.
  [[nodiscard]] glm::dvec3 apply(const glm::dvec3& wanted_n, const glm::dvec3& device_mm, double elapsed_s,
                                 const glm::dvec3& edge_n = glm::dvec3(0)) RELIEVO_RT;
  void reset() RELIEVO_RT;

  // Rate at which the scene changed the force in the last `apply`: (|change| - stiffness x moved)/elapsed, at least 0.
  [[nodiscard]] double sceneSlew() const RELIEVO_RT { return scene_slew_; }
  // Accumulated since construction.
  [[nodiscard]] const EnergyBooks& books() const RELIEVO_RT { return books_; }
  // The share of the method's force that is passed on: below 1 only after the scene has leapt several times.
  [[nodiscard]] double share() const RELIEVO_RT;

 private:
  void lean(const glm::dvec3& spring_n, const glm::dvec3& moved_mm, double elapsed_s) RELIEVO_RT;
  void payForLag(const glm::dvec3& wanted_n, const glm::dvec3& moved_mm, double elapsed_s) RELIEVO_RT;

  SafetyLimits limits_;
  double stiffness_ = 0;
  EnergyBooks books_;
  bool primed_ = false;  // a previous tick exists
  glm::dvec3 last_device_mm_{0};
  glm::dvec3 spring_n_{0};  // after every limit except that on artefact energy
  glm::dvec3 sent_n_{0};
  glm::dvec3 lean_n_{0};
  double since_moved_s_ = 0, pace_s_ = 0;  // time since the last new position; interval between the last two
  double scene_slew_ = 0;
  double tank_mj_ = limits_.tank_mj;
};

}  // namespace relievo
