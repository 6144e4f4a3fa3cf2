// SPDX-License-Identifier: Apache-2.0
// Semi-implicit Euler in small steps, both frictions at the end of the step.
#include "app/lab/finger/hand_loop.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace relievo {

HandLoopProfile HandLoopProfile::deviceAlone(int delay_ticks) {
  return {.coulomb_friction_n = 0,
          .encoder_step_mm = 0,
          .delay_ticks = delay_ticks,
          .hand_mass_kg = 0,
          .hand_stiffness_n_per_mm = 0,
          .hand_damping_n_s_per_mm = 0};
}

double HandLoopProfile::viscousBound() const {
  return 2 * damping_n_s_per_mm / ((1 + 2 * delay_ticks) * tick_s);
}

double HandLoopProfile::frictionBound() const {
  return encoder_step_mm > 0 ? 2 * coulomb_friction_n / encoder_step_mm : std::numeric_limits<double>::infinity();
}

HandLoop::HandLoop(const HandLoopProfile& profile, const glm::dvec3& position_mm)
    : profile_(profile), position_(position_mm) {}

glm::dvec3 HandLoop::encoded() const {
  const double step = profile_.encoder_step_mm;
  return step > 0 ? glm::round(position_ / step) * step : position_;
}

void HandLoop::tick(const glm::dvec3& written_n, const glm::dvec3& target_mm, const glm::dvec3& push_n) {
  std::move_backward(late_.begin(), late_.end() - 1, late_.end());
  late_.front() = written_n;
  const glm::dvec3 steady = late_[static_cast<std::size_t>(profile_.delay_ticks)] + push_n;
  const double mass = profile_.device_mass_kg + profile_.hand_mass_kg;
  const double damping = profile_.damping_n_s_per_mm + profile_.hand_damping_n_s_per_mm;
  const double dt = profile_.tick_s / HandLoopProfile::kStepsPerTick;
  constexpr double kMmPerM = 1e3;  // 1 N moves 1 kg by 1000 mm/s^2
  const double whole = mass + kMmPerM * dt * damping;
  for (int i = 0; i < HandLoopProfile::kStepsPerTick; ++i) {
    const glm::dvec3 pull = steady + profile_.hand_stiffness_n_per_mm * (target_mm - position_);
    const glm::dvec3 free = (mass * velocity_ + kMmPerM * dt * pull) / whole;
    // Dry friction takes so much off the speed at most; where that is all of it, the mass stops (Moreau).
    const double friction = kMmPerM * dt * profile_.coulomb_friction_n / whole, speed = glm::length(free);
    const glm::dvec3 before = velocity_;
    velocity_ = speed <= friction ? glm::dvec3(0) : free * (1 - friction / speed);
    // The mean of both speeds: with the new one alone every force would act half a step early.
    position_ += 0.5 * dt * (before + velocity_);
  }
}

}  // namespace relievo
