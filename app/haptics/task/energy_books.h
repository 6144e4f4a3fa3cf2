// SPDX-License-Identifier: Apache-2.0
// Accounts for the energy that enters the hand: one book for the scene's own work, one for artefacts of sampling.
#pragma once

#include <glm/vec3.hpp>

#include "platform/realtime.h"

namespace relievo {

// A spring K between proxy p and finger h stores U = F^2/2K and pushes the hand with F = K(p - h). From dU = F.(dp -
// dh), the work on the hand F.dh is the proxy's work F.dp minus what the spring stores. Sliding does no work (F is
// normal to the surface), so F.dp is the work of the moving surface: the scene's book, by the trapezoid rule. But the
// device holds each force until the next tick, and the limits delay it. The work of the held force minus that of the
// wanted force, by the trapezoid rule, is the artefacts' book. Units: N mm = mJ. Positive means energy given to the
// hand.
//
// With friction the proxy slides against the force: the energy that this takes from the hand is booked as a loss in the
// scene's book.
//
// A device may report a new position only in every other tick although the finger moves all the time. The force held
// between two positions is then the mean of those sent; after kRestS without a new position the finger counts as
// resting.
class EnergyBooks {
 public:
  explicit EnergyBooks(double stiffness_n_per_mm = 1) noexcept : stiffness_(stiffness_n_per_mm) {}

  // Call once a tick: the spring's force after the scene's slew limit, the force that the method wanted, and the force
  // that is sent instead and held until the next tick. `elapsed_s` is the time since the last tick.
  void tick(const glm::dvec3& device_mm, const glm::dvec3& spring_n, const glm::dvec3& wanted_n,
            const glm::dvec3& sent_n, double elapsed_s) RELIEVO_RT;
  void reset() RELIEVO_RT { primed_ = false; }

  [[nodiscard]] double sceneMj() const RELIEVO_RT { return scene_; }
  [[nodiscard]] double artefactMj() const RELIEVO_RT { return artefact_; }
  // The artefacts' balance for a limiter: energy taken from the hand earns no credit, and of the debt that a jump of
  // the scene leaves at most kMostOpenMj is recovered.
  static constexpr double kMostOpenMj = 1.0;
  static constexpr double kRestS = 0.02;
  [[nodiscard]] double openArtefactMj() const RELIEVO_RT { return open_artefact_; }

 private:
  void beginWay(const glm::dvec3& wanted_n) RELIEVO_RT;

  double stiffness_;
  bool primed_ = false;
  glm::dvec3 last_device_mm_{0};
  glm::dvec3 spring_{0}, sent_{0};
  // At the last new position: the force wanted there; since then: the impulse sent.
  glm::dvec3 wanted_{0}, held_impulse_{0};
  double held_s_ = 0;
  double scene_ = 0;
  double artefact_ = 0;
  double open_artefact_ = 0;
};

}  // namespace relievo
