// SPDX-License-Identifier: Apache-2.0
// The simulated device's integration compared with closed-form mechanics.
#include <gtest/gtest.h>

#include <cmath>

#include "hal/moving_mass.h"

namespace relievo {
namespace {

constexpr double kStepS = 1e-3 / 16;

void run(MovingMass& mass, const glm::dvec3& force_n, double seconds) {
  const int steps = static_cast<int>(std::lround(seconds / kStepS));
  for (int i = 0; i < steps; ++i) mass.step(force_n, kStepS);
}

// m v' = F - b v from rest: v = F/b (1 - exp(-t/tau)), x = F/b (t - tau (1 - exp(-t/tau))), tau = m/b.
// Here F/b = 50 mm/s and tau = 37.5 ms. A first-order step is late or early by at most half of itself: 31 us.
TEST(SimMovingMass, ConstantForceAgainstViscousDamping) {
  MovingMass mass{.mass_kg = 0.075, .damping_n_s_per_mm = 0.002};
  for (const double t_s : {0.02, 0.04, 0.06, 0.08, 0.10, 0.12}) {
    run(mass, {0.1, 0, 0}, 0.02);
    const double rise = 1.0 - std::exp(-t_s / 0.0375);
    EXPECT_NEAR(mass.velocity_mm_per_s.x, 50.0 * rise, 50.0 / 0.0375 * std::exp(-t_s / 0.0375) * 31.25e-6 + 0.01);
    EXPECT_NEAR(mass.position_mm.x, 50.0 * (t_s - 0.0375 * rise), 50.0 * 31.25e-6);
  }
  EXPECT_EQ(mass.position_mm.y, 0.0);
  EXPECT_EQ(mass.position_mm.z, 0.0);
}

// 0.1 N on 0.1 kg is 1 m/s^2: after 0.1 s 100 mm/s and 5 mm.
TEST(SimMovingMass, GainsSpeedSteadilyUnderAConstantForce) {
  MovingMass mass{.mass_kg = 0.1};
  run(mass, {0, 0, -0.1}, 0.1);
  EXPECT_NEAR(mass.velocity_mm_per_s.z, -100.0, 1e-9);
  EXPECT_NEAR(mass.position_mm.z, -5.0, 100.0 * 31.25e-6 + 1e-9);
}

TEST(SimMovingMass, StaysExactlyWhereItIsBelowCoulombFriction) {
  MovingMass mass{.mass_kg = 0.075, .damping_n_s_per_mm = 0.002, .coulomb_friction_n = 0.04};
  mass.position_mm = {1, 2, 3};
  run(mass, {0.0399, 0, 0}, 10.0);
  for (int i = 0; i < 1000; ++i) {  // a shaking force must not make it creep
    run(mass, {0, 0, i % 2 == 0 ? 0.039 : -0.039}, 0.001);
  }
  EXPECT_EQ(mass.position_mm, glm::dvec3(1, 2, 3));
  EXPECT_EQ(mass.velocity_mm_per_s, glm::dvec3(0));
}

// Friction acts on the whole force, not on each axis: 0.03 N along x and along y are 0.0424 N.
TEST(SimMovingMass, MovesAboveCoulombFrictionAlongTheForce) {
  MovingMass mass{.mass_kg = 0.075, .coulomb_friction_n = 0.04};
  run(mass, {0.03, 0.03, 0}, 1.0);
  EXPECT_GT(mass.position_mm.x, 1.0);
  EXPECT_NEAR(mass.position_mm.x, mass.position_mm.y, 1e-12);
  // a = (0.0424264 - 0.04) N / 0.075 kg = 32.352 mm/s^2, 16.176 mm in 1 s, of which cos 45 along x.
  EXPECT_NEAR(mass.position_mm.x, 11.438, 0.002);
}

// From v = 50 mm/s, dry friction of 0.04 N stops 0.075 kg after m v/f = 93.75 ms and m v^2/(2 f) = 2.34375
// mm.
TEST(SimMovingMass, SlidesToAStopAsDryFrictionDecelerates) {
  MovingMass mass{.mass_kg = 0.075, .coulomb_friction_n = 0.04};
  mass.velocity_mm_per_s = {30, -40, 0};
  run(mass, glm::dvec3(0), 0.0936);
  EXPECT_GT(glm::length(mass.velocity_mm_per_s), 0.0);
  run(mass, glm::dvec3(0), 0.0003);
  EXPECT_EQ(mass.velocity_mm_per_s, glm::dvec3(0));
  EXPECT_NEAR(glm::length(mass.position_mm), 2.34375, 50.0 * 31.25e-6 + 1e-9);
  EXPECT_NEAR(mass.position_mm.x / mass.position_mm.y, -0.75, 1e-9);
  const glm::dvec3 stopped = mass.position_mm;
  run(mass, glm::dvec3(0), 1.0);
  EXPECT_EQ(mass.position_mm, stopped);
}

}  // namespace
}  // namespace relievo
