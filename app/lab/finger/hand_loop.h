// SPDX-License-Identifier: Apache-2.0
// A device in a hand: mass, friction, encoder, amplifier and delay of the one; spring, damper and mass of the other.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

namespace relievo {

// The defaults are a device like the PHANToM Premium 1.5 (apparent mass, back-drive friction and encoder as published,
// viscous damping assumed) and a hand on its stylus, critically damped with the device.
struct HandLoopProfile {
  double device_mass_kg = 0.075;
  double damping_n_s_per_mm = 0.002;
  double coulomb_friction_n = 0.04;
  double encoder_step_mm = 0.03;  // 0: positions are exact
  int delay_ticks = 1;            // from the tick that writes a force to the one from which it acts
  double hand_mass_kg = 0.1;
  double hand_stiffness_n_per_mm = 0.3;
  double hand_damping_n_s_per_mm = 0.0145;
  double tick_s = 0.001;

  static constexpr int kStepsPerTick = 16;
  static constexpr int kMaxDelayTicks = 8;

  // The device alone, pushed by a steady force: what the theory's bounds are about.
  [[nodiscard]] static HandLoopProfile deviceAlone(int delay_ticks);
  // A force that is held for a tick T and n ticks late is late by (n + 1/2) T on the whole, which makes of a spring K
  // one with a damper of -K (n + 1/2) T: the device's own b makes good for it up to here (Colgate and Schenkel, n = 0).
  [[nodiscard]] double viscousBound() const;
  // 2 f_c/step: what dry friction holds still of a spring that jumps by a step (Abbott and Okamura 2005, eq. 16).
  [[nodiscard]] double frictionBound() const;
};

class HandLoop {
 public:
  HandLoop(const HandLoopProfile& profile, const glm::dvec3& position_mm);

  [[nodiscard]] glm::dvec3 encoded() const;  // what the device says
  [[nodiscard]] const glm::dvec3& position() const { return position_; }
  // One tick: `written_n` goes into the delay and what comes out of it is held; the hand pulls to `target_mm`, and
  // pushes with `push_n` besides.
  void tick(const glm::dvec3& written_n, const glm::dvec3& target_mm, const glm::dvec3& push_n = glm::dvec3(0));

 private:
  HandLoopProfile profile_;
  glm::dvec3 position_, velocity_{0};
  std::array<glm::dvec3, HandLoopProfile::kMaxDelayTicks + 1> late_{};  // [0] is the newest force
};

}  // namespace relievo
