// SPDX-License-Identifier: Apache-2.0
// The limits that every force passes, and the two energy books.
#include "app/haptics/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "app/haptics/energy_books.h"

namespace relievo {
namespace {

constexpr double kTick = 0.001;

TEST(SafetyFilter, FadesInAtTheScenesSlewLimitWhenTheHandStandsStill) {
  SafetyFilter filter({}, 0.5);
  for (int i = 1; i <= 30; ++i) {
    const double expected = std::min(1.0, 0.05 * i);  // 50 N/s over 1 ms
    ASSERT_NEAR(filter.apply({0, 0, 1}, 0, kTick).z, expected, 1e-12);
    ASSERT_LE(filter.sceneSlew(), 50 + 1e-9);
  }
}

TEST(SafetyFilter, LetsTheHandChangeTheForceAsFastAsItMoves) {
  SafetyFilter filter({}, 0.5);
  // 2 mm in one tick is 1 N at 0.5 N/mm: all of it at once, and none of it the scene's doing.
  EXPECT_NEAR(filter.apply({0, 0, 1}, 2.0, kTick).z, 1.0, 1e-12);
  EXPECT_EQ(filter.sceneSlew(), 0);
  EXPECT_NEAR(filter.apply({0, 0, 0}, 2.0, kTick).z, 0.0, 1e-12);
}

TEST(SafetyFilter, CutsTheMagnitudeAndKeepsTheDirection) {
  SafetyFilter filter({.force_n = 5}, 100);
  const glm::dvec3 force = filter.apply({30, 40, 0}, 1000, kTick);
  EXPECT_NEAR(force.x, 3, 1e-12);
  EXPECT_NEAR(force.y, 4, 1e-12);
}

TEST(SafetyFilter, TreatsWhatIsNotFiniteAsZeroForce) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    SafetyFilter filter({}, 0.5);
    static_cast<void>(filter.apply({0, 0, 1}, 10, kTick));
    const glm::dvec3 force = filter.apply({0, bad, 0}, 0, kTick);
    EXPECT_NEAR(force.z, 0.95, 1e-12) << "towards zero, at the scene's rate";
    EXPECT_TRUE(std::isfinite(filter.apply({0, 0, 1}, bad, bad).z));
  }
}

TEST(SafetyFilter, StartsFromZeroAfterReset) {
  SafetyFilter filter({}, 0.5);
  static_cast<void>(filter.apply({0, 0, 1}, 10, kTick));
  filter.reset();
  EXPECT_NEAR(filter.apply({0, 0, 1}, 0, kTick).z, 0.05, 1e-12);
}

TEST(EnergyBooks, AStillWallTakesNothingFromTheSceneAndGivesHalfKDxSquaredPerHeldTick) {
  // In and out of a wall K = 0.5 N/mm in steps of 0.1 mm, 2 mm deep, without friction. The exact work over the closed
  // path is zero. Held over the tick, each step in or out gives the hand K dx^2/2: 40 steps, 40 x 0.0025 mJ.
  EnergyBooks books(0.5);
  const auto tick = [&](double depth) { books.tick({0, 0, -depth}, {0, 0, 0.5 * depth}); };
  for (int i = 0; i <= 20; ++i) tick(0.1 * i);
  for (int i = 19; i >= 0; --i) tick(0.1 * i);
  EXPECT_NEAR(books.sceneMj(), 0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 40 * 0.5 * 0.5 * 0.01, 1e-9);
}

TEST(EnergyBooks, ARisingSurfaceIsBookedToTheScene) {
  // The surface rises 2 mm through a finger that stands still: the spring is loaded with K d^2/2 = 1 mJ.
  EnergyBooks books(0.5);
  for (int i = 0; i <= 200; ++i) books.tick({0, 0, 0}, {0, 0, 0.5 * 0.01 * i});
  EXPECT_NEAR(books.sceneMj(), 1.0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 0, 1e-12);
}

TEST(EnergyBooks, SlidingAlongAStillSlopeIsNoWork) {
  EnergyBooks books(0.5);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.3, 0, 1)), along = glm::normalize(glm::dvec3(1, 0, 0.3));
  for (int i = 0; i <= 100; ++i) books.tick(0.1 * i * along, 1.5 * normal);
  EXPECT_NEAR(books.sceneMj(), 0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 0, 1e-9);
}

}  // namespace
}  // namespace relievo
