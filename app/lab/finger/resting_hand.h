// SPDX-License-Identifier: Apache-2.0
// A hand that rests on a moving surface: a mass on a spring and a damper, under a force that is held for a tick.
#pragma once

#include <glm/vec3.hpp>

namespace relievo {

// 0.1 kg on 0.3 N/mm is a hand on a stylus; the damping is critical, 2 sqrt(0.3 N/mm x 0.1 kg), as a resting hand does
// not ring. The device that it holds weighs nothing here.
struct RestingHand {
  static constexpr double kMassKg = 0.1, kStiffnessNPerMm = 0.3, kDampingNSPerMm = 0.011;
  static constexpr int kStepsPerTick = 16;

  glm::dvec3 position_mm{0};
  glm::dvec3 velocity_mm_per_s{0};

  // Semi-implicit Euler, the damper at the end of each step.
  void move(const glm::dvec3& target_mm, const glm::dvec3& force_n, double tick_s) {
    const double dt = tick_s / kStepsPerTick;
    const double per_newton = 1e3 * dt / (kMassKg + 1e3 * dt * kDampingNSPerMm);  // 1 N moves 1 kg by 1000 mm/s^2
    const double keeps = kMassKg / (kMassKg + 1e3 * dt * kDampingNSPerMm);
    for (int i = 0; i < kStepsPerTick; ++i) {
      const glm::dvec3 pull = force_n + kStiffnessNPerMm * (target_mm - position_mm);
      velocity_mm_per_s = keeps * velocity_mm_per_s + per_newton * pull;
      position_mm += dt * velocity_mm_per_s;
    }
  }
};

}  // namespace relievo
