// SPDX-License-Identifier: Apache-2.0
// The limits that every force passes, and the two energy books.
#include "app/haptics/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "app/haptics/energy_books.h"

namespace relievo {
namespace {

constexpr double kTick = 0.001;
constexpr glm::dvec3 kRest(0);

TEST(SafetyFilter, FadesInAtTheScenesSlewLimitWhenTheHandStandsStill) {
  SafetyFilter filter({}, 0.5);
  for (int i = 1; i <= 30; ++i) {
    const double expected = std::min(1.0, 0.05 * i);  // 50 N/s over 1 ms
    ASSERT_NEAR(filter.apply({0, 0, 1}, kRest, kTick).z, expected, 1e-12);
    ASSERT_LE(filter.sceneSlew(), 50 + 1e-9);
  }
}

TEST(SafetyFilter, LetsTheHandChangeTheForceAsFastAsItMoves) {
  SafetyFilter filter({.limit_energy = false}, 0.5);
  static_cast<void>(filter.apply({0, 0, 0}, {0, 0, 2}, kTick));
  // 2 mm in one tick is 1 N at 0.5 N/mm: all of it at once, and none of it the scene's doing.
  EXPECT_NEAR(filter.apply({0, 0, 1}, {0, 0, 0}, kTick).z, 1.0, 1e-12);
  EXPECT_EQ(filter.sceneSlew(), 0);
  EXPECT_NEAR(filter.apply({0, 0, 0}, {0, 0, 2}, kTick).z, 0.0, 1e-12);
}

TEST(SafetyFilter, CutsTheMagnitudeAndKeepsTheDirection) {
  SafetyFilter filter({.force_n = 5, .limit_energy = false}, 100);
  static_cast<void>(filter.apply({0, 0, 0}, {1000, 0, 0}, kTick));
  const glm::dvec3 force = filter.apply({30, 40, 0}, kRest, kTick);
  EXPECT_NEAR(force.x, 3, 1e-12);
  EXPECT_NEAR(force.y, 4, 1e-12);
}

TEST(SafetyFilter, TreatsWhatIsNotFiniteAsZeroForce) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    SafetyFilter filter({.limit_energy = false}, 0.5);
    static_cast<void>(filter.apply({0, 0, 0}, {0, 0, 10}, kTick));
    static_cast<void>(filter.apply({0, 0, 1}, kRest, kTick));
    const glm::dvec3 force = filter.apply({0, bad, 0}, kRest, kTick);
    EXPECT_NEAR(force.z, 0.95, 1e-12) << "towards zero, at the scene's rate";
    EXPECT_TRUE(std::isfinite(filter.apply({0, 0, 1}, {0, 0, bad}, bad).z));
    EXPECT_TRUE(std::isfinite(filter.apply({0, 0, 1}, kRest, kTick).z));
  }
}

TEST(SafetyFilter, AReadingThatIsNoneOpensNoLimit) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SafetyFilter filter({}, 0.5);
  static_cast<void>(filter.apply({0, 0, 0}, kRest, kTick));
  EXPECT_LE(glm::length(filter.apply({0, 0, 9}, {0, 0, nan}, kTick)), 0.05 + 1e-9);
  EXPECT_LE(glm::length(filter.apply({0, 0, 9}, kRest, nan)), 0.05 + 1e-9) << "no time has passed";
}

TEST(SafetyFilter, StartsFromZeroAfterReset) {
  SafetyFilter filter({}, 0.5);
  for (int i = 0; i < 40; ++i) static_cast<void>(filter.apply({0, 0, 1}, kRest, kTick));
  filter.reset();
  EXPECT_NEAR(filter.apply({0, 0, 1}, {5, 5, 5}, kTick).z, 0.05, 1e-12) << "a finger found elsewhere has not moved";
}

// In and out of a wall of 0.5 N/mm, 5 mm deep, as a cosine of time: a closed path, on which a spring gives nothing.
double heldWorkOnAWall(const SafetyLimits& limits, double top_speed_mm_per_s) {
  SafetyFilter filter(limits, 0.5);
  const double period = 5 * std::numbers::pi / top_speed_mm_per_s;
  const int ticks = static_cast<int>(std::lround(period / kTick));
  double work = 0, z = 0, force = filter.apply({}, {0, 0, 0}, kTick).z;
  for (int i = 1; i <= ticks; ++i) {
    const double next = -2.5 * (1 - std::cos(2 * std::numbers::pi * i / ticks));
    work += force * (next - z);
    z = next;
    force = filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick).z;
  }
  return work;
}

TEST(SafetyFilter, HeldForceGivesTheHandNoEnergyOverAClosedPath) {
  for (const double speed : {20.0, 100.0, 500.0}) {
    EXPECT_GT(heldWorkOnAWall({.limit_energy = false}, speed), 0.0004 * speed) << "sampling alone gives energy";
    EXPECT_LE(heldWorkOnAWall({}, speed), 0.05) << speed;
    EXPECT_GE(heldWorkOnAWall({}, speed), -0.02 * 6.25) << "and the limiter is no brake: under 2 % of the spring's";
  }
}

TEST(SafetyFilter, LeansAgainstTheMotionByNoMoreThanTheSpringOfTwoTicks) {
  SafetyFilter filter({}, 0.5);
  SafetyFilter plain({.limit_energy = false}, 0.5);
  std::mt19937 random(3);
  std::normal_distribution<double> step(0, 0.3);
  glm::dvec3 hip(0), before(0);
  double moved_before = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 wanted(0, 0, std::max(-0.5 * hip.z, 0.0));
    const double off = glm::length(filter.apply(wanted, hip, kTick) - plain.apply(wanted, hip, kTick));
    ASSERT_LE(off, 0.5 * (glm::length(hip - before) + moved_before) + 1e-9) << i;
    moved_before = glm::length(hip - before);
    before = hip;
    hip += glm::dvec3(step(random), step(random), step(random));
    hip.z = std::clamp(hip.z, -5.0, 1.0);
  }
}

TEST(EnergyBooks, AStillWallTakesNothingFromTheSceneAndGivesHalfKDxSquaredPerHeldTick) {
  // In and out of a wall K = 0.5 N/mm in steps of 0.1 mm, 2 mm deep, without friction. The exact work over the closed
  // path is zero. Held over the tick, each step in or out gives the hand K dx^2/2: 40 steps, 40 x 0.0025 mJ.
  EnergyBooks books(0.5);
  const auto tick = [&](double depth) {
    const glm::dvec3 force(0, 0, 0.5 * depth);
    books.tick({0, 0, -depth}, force, force, force);
  };
  for (int i = 0; i <= 20; ++i) tick(0.1 * i);
  for (int i = 19; i >= 0; --i) tick(0.1 * i);
  EXPECT_NEAR(books.sceneMj(), 0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 40 * 0.5 * 0.5 * 0.01, 1e-9);
}

TEST(EnergyBooks, ARisingSurfaceIsBookedToTheScene) {
  // The surface rises 2 mm through a finger that stands still: the spring is loaded with K d^2/2 = 1 mJ.
  EnergyBooks books(0.5);
  for (int i = 0; i <= 200; ++i) {
    const glm::dvec3 force(0, 0, 0.5 * 0.01 * i);
    books.tick({0, 0, 0}, force, force, force);
  }
  EXPECT_NEAR(books.sceneMj(), 1.0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 0, 1e-12);
}

TEST(EnergyBooks, SlidingAlongAStillSlopeIsNoWork) {
  EnergyBooks books(0.5);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.3, 0, 1)), along = glm::normalize(glm::dvec3(1, 0, 0.3));
  for (int i = 0; i <= 100; ++i) books.tick(0.1 * i * along, 1.5 * normal, 1.5 * normal, 1.5 * normal);
  EXPECT_NEAR(books.sceneMj(), 0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 0, 1e-9);
}

}  // namespace
}  // namespace relievo
