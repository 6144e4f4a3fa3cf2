// SPDX-License-Identifier: Apache-2.0
// Bounds of the stiffness that a device renders without oscillating.
#include "hal/device_profile.h"

#include <algorithm>
#include <limits>

namespace relievo {

double DeviceProfile::viscousBound() const RELIEVO_RT {
  const int delay = std::clamp(delay_ticks, 0, kMaxDelayTicks);
  const double late_ticks = 0.5 + static_cast<double>(delay) + std::clamp(jitter_ticks, 0.0, 1.0);
  return damping_n_s_per_mm * rate_hz / late_ticks;
}

double DeviceProfile::frictionBound() const RELIEVO_RT {
  const bool holds = encoder_step_mm > 0 && coulomb_friction_n > 0;
  return holds ? 2 * coulomb_friction_n / encoder_step_mm : std::numeric_limits<double>::infinity();
}

}  // namespace relievo
