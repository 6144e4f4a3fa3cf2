// SPDX-License-Identifier: Apache-2.0
// The device's side of a tick: delay, amplifier, encoder.
#include "app/lab/finger/hand_loop.h"

#include <algorithm>
#include <glm/common.hpp>

namespace relievo {

DeviceProfile deviceAlone(int delay_ticks) {
  DeviceProfile alone;
  alone.coulomb_friction_n = alone.encoder_step_mm = 0;
  alone.delay_ticks = delay_ticks;
  alone.hand = {.mass_kg = 0, .stiffness_n_per_mm = 0, .damping_n_s_per_mm = 0};
  return alone;
}

HandLoop::HandLoop(const DeviceProfile& profile, const glm::dvec3& position_mm)
    : profile_(profile),
      mass_{.mass_kg = profile.moving_mass_kg + profile.hand.mass_kg,
            .damping_n_s_per_mm = profile.damping_n_s_per_mm + profile.hand.damping_n_s_per_mm,
            .coulomb_friction_n = profile.coulomb_friction_n,
            .position_mm = position_mm} {}

glm::dvec3 HandLoop::encoded() const {
  const double step = profile_.encoder_step_mm;
  return step > 0 ? glm::round(position() / step) * step : position();
}

void HandLoop::tick(const glm::dvec3& written_n, const glm::dvec3& target_mm, const glm::dvec3& push_n) {
  std::move_backward(late_.begin(), late_.end() - 1, late_.end());
  late_.front() = written_n;
  const glm::dvec3 steady = late_[static_cast<std::size_t>(profile_.delay_ticks)] + push_n;
  const double dt_s = 1 / profile_.rate_hz / profile_.substeps_per_tick;
  for (int i = 0; i < profile_.substeps_per_tick; ++i) {
    mass_.step(steady + profile_.hand.stiffness_n_per_mm * (target_mm - position()), dt_s);
  }
}

}  // namespace relievo
