// SPDX-License-Identifier: Apache-2.0
// Mechanical parameters of a haptic device and the hand that holds it, for the simulated back end and the laboratory.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "hal/haptic_rate.h"
#include "platform/realtime.h"

namespace relievo {

// A hand that holds the handle: its mass moves with the device's, and a spring and a damper pull both to the hand's
// target. 0.1 kg and 0.3 N/mm are a hand on a stylus; a whole relaxed arm was measured at about 0.55 kg, 0.14 N/mm and
// 0.0065 N.s/mm (one fit of Sci. Rep. 5:18004, 2015, figure 3). The damping is critical for hand and device together,
// 2 sqrt(0.3 N/mm x 0.175 kg) = 0.0145 N.s/mm, since a resting hand does not ring.
struct HandProfile {
  double mass_kg = 0.1;
  double stiffness_n_per_mm = 0.3;
  double damping_n_s_per_mm = 0.0145;
};

// The defaults are those of a device like the PHANToM Premium 1.5; drivers/sim/profiles.h gives their sources and the
// values of other devices.
struct DeviceProfile {
  const char* name = "sim";
  double moving_mass_kg = 0.075;
  double damping_n_s_per_mm = 0.002;
  double coulomb_friction_n = 0.04;
  double encoder_step_mm = 0.03;  // 0: positions are exact
  double peak_force_n = 8.5;
  double continuous_force_n = 1.4;
  double most_stiffness_n_per_mm = 3.5;         // of its own parts; it cannot render a stiffer wall
  glm::dvec3 workspace_min_mm{-100, -80, -40};  // end stops: the mass comes to rest there
  glm::dvec3 workspace_max_mm{100, 80, 80};
  double rate_hz = 1000;
  double most_rate_hz = kMostRateHz;  // the highest that can be requested; delay and jitter keep their number of ticks
  int delay_ticks = 1;                // a force acts this many writes later, at most kMaxDelayTicks; 0: at once
  double jitter_ticks = 0;            // a further random delay, new each tick, from 0 to this; at most 1
  std::uint64_t jitter_seed = 1;
  int substeps_per_tick = 16;  // of the integration
  HandProfile hand;

  static constexpr int kMaxDelayTicks = 8;

  // The stiffness above which a wall oscillates on the device alone. A force that is held for a tick and n ticks late
  // is late by (n + 1/2) T, and a spring K that is late by a short time t acts as a spring with a damper of -K t. The
  // device's own damping b outweighs that up to K = 2 b/((1 + 2 n) T). (Colgate and Schenkel 1994 for n = 0.)
  [[nodiscard]] double viscousBound() const RELIEVO_RT;
  // 2 f_c/step: the stiffness up to which dry friction absorbs the force of one encoder step (Abbott and Okamura 2005,
  // eq. 16). Infinite where the bound does not apply: without an encoder, and without friction, where the device
  // oscillates by one encoder step at any stiffness.
  [[nodiscard]] double frictionBound() const RELIEVO_RT;
};

}  // namespace relievo
