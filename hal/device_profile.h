// SPDX-License-Identifier: Apache-2.0
// A haptic device and the hand on it as bodies, for whoever computes them: the simulated back end and the laboratory.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "platform/realtime.h"

namespace relievo {

// A hand that holds the handle: its mass moves with the device's, a spring and a damper pull both to where it wants to
// be. 0.1 kg on 0.3 N/mm is a hand on a stylus; a whole relaxed arm was measured at about 0.55 kg, 0.14 N/mm and
// 0.0065 N.s/mm (one fit of Sci. Rep. 5:18004, 2015, figure 3). The damping is critical for hand and device together,
// 2 sqrt(0.3 N/mm x 0.175 kg) = 0.0145 N.s/mm, as a resting hand does not ring.
struct HandProfile {
  double mass_kg = 0.1;
  double stiffness_n_per_mm = 0.3;
  double damping_n_s_per_mm = 0.0145;
};

// The defaults are those of a device like the PHANToM Premium 1.5; drivers/sim/profiles.h says where they come from,
// and has those of other devices.
struct DeviceProfile {
  const char* name = "sim";
  double moving_mass_kg = 0.075;
  double damping_n_s_per_mm = 0.002;
  double coulomb_friction_n = 0.04;
  double encoder_step_mm = 0.03;  // 0: positions are exact
  double peak_force_n = 8.5;
  double continuous_force_n = 1.4;
  double most_stiffness_n_per_mm = 3.5;         // of its own parts; no wall is stiffer
  glm::dvec3 workspace_min_mm{-100, -80, -40};  // end stops: the mass comes to rest there
  glm::dvec3 workspace_max_mm{100, 80, 80};
  double rate_hz = 1000;
  int delay_ticks = 1;      // a force acts from so many writes later, at most kMaxDelayTicks; 0: at once
  double jitter_ticks = 0;  // and up to so much after that, at random, another time each tick; at most 1
  std::uint64_t jitter_seed = 1;
  int substeps_per_tick = 16;  // of the integration
  HandProfile hand;

  static constexpr int kMaxDelayTicks = 8;

  // From which stiffness on a wall swings by itself, on the device alone. A force held over a tick and n ticks late is
  // late by (n + 1/2) T, and a spring K that is late by a short while t is a spring with a damper of -K t: the device's
  // own damping b outweighs it up to K = 2 b/((1 + 2 n) T). (Colgate and Schenkel 1994 for n = 0.)
  [[nodiscard]] double viscousBound() const RELIEVO_RT;
  // 2 f_c/step: what dry friction holds still of a spring that jumps by a step of the encoder (Abbott and Okamura 2005,
  // eq. 16). Infinite without an encoder or without friction, where a cycle is an encoder's step at any stiffness.
  [[nodiscard]] double frictionBound() const RELIEVO_RT;
};

}  // namespace relievo
