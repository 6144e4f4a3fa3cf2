// SPDX-License-Identifier: Apache-2.0
// Two books on the energy that goes into the hand: one for the scene's own work, one for artefacts of sampling.
#pragma once

#include <glm/vec3.hpp>

#include "platform/realtime.h"

namespace relievo {

// A spring K between proxy p and finger h holds U = F^2/2K and pushes the hand with F = K(p - h). From dU = F.(dp -
// dh): the work on the hand F.dh is the proxy's work F.dp less what the spring takes up. Sliding does no work (F is
// normal to the surface), so F.dp is what the moving surface puts in: the scene's book, by the trapezoid rule. The
// device however holds each force until the next tick, and the limits make it lag; what the held force does beyond the
// work of the force that the method wanted, by the trapezoid rule, is the artefacts' book. Units: N mm = mJ. Positive
// is energy given to the hand.
//
// A device may have a new position in every other tick only: the finger has moved all the while. What was held on the
// way from one position to the next is the mean of what was sent; after kRestS without a new one the finger rests.
class EnergyBooks {
 public:
  explicit EnergyBooks(double stiffness_n_per_mm = 1) noexcept : stiffness_(stiffness_n_per_mm) {}

  // Once a tick: the force of the spring as far as the scene may change it, the one that the method wanted, and the one
  // that is sent in its place and held until the next tick. `elapsed_s`: since the last tick.
  void tick(const glm::dvec3& device_mm, const glm::dvec3& spring_n, const glm::dvec3& wanted_n,
            const glm::dvec3& sent_n, double elapsed_s) RELIEVO_RT;
  void reset() RELIEVO_RT { primed_ = false; }

  [[nodiscard]] double sceneMj() const RELIEVO_RT { return scene_; }
  [[nodiscard]] double artefactMj() const RELIEVO_RT { return artefact_; }
  // The artefacts' book as a limiter should see it: what the hand has put in is no credit for later,
  // and of what a jump of the scene left open no more than kMostOpenMj is asked back.
  static constexpr double kMostOpenMj = 1.0;
  static constexpr double kRestS = 0.02;
  [[nodiscard]] double openArtefactMj() const RELIEVO_RT { return open_artefact_; }

 private:
  void beginWay(const glm::dvec3& wanted_n) RELIEVO_RT;

  double stiffness_;
  bool primed_ = false;
  glm::dvec3 last_device_mm_{0};
  glm::dvec3 spring_{0}, sent_{0};
  // Since the position was last another one: what the method wanted there, and what was sent.
  glm::dvec3 wanted_{0}, held_ns_{0};
  double held_s_ = 0;
  double scene_ = 0;
  double artefact_ = 0;
  double open_artefact_ = 0;
};

}  // namespace relievo
