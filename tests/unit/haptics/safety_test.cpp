// SPDX-License-Identifier: Apache-2.0
// The limits that every force passes, and the two energy books.
#include "app/haptics/task/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "app/haptics/task/energy_books.h"

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
  // 2 mm in one tick is 1 N at 0.5 N/mm: allowed at once, since the hand caused it.
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
    EXPECT_TRUE(std::isfinite(filter.books().sceneMj() + filter.books().artefactMj()));
  }
}

// For a second the scene asks for far more force than the limit. When it then asks for none, the force falls at the
// scene's rate at once: the excess was not saved up.
TEST(SafetyFilter, AForceOverTheLimitIsNotRememberedBeyondIt) {
  SafetyFilter filter({.force_n = 5, .limit_energy = false}, 0.5);
  for (int i = 0; i < 1000; ++i) static_cast<void>(filter.apply({0, 0, 100}, kRest, kTick));
  EXPECT_NEAR(filter.apply({0, 0, 0}, kRest, kTick).z, 4.95, 1e-9);
  double last = 0;
  for (int i = 1; i < 100; ++i) last = filter.apply({0, 0, 0}, kRest, kTick).z;
  EXPECT_NEAR(last, 0, 1e-9) << "5 N at 50 N/s are a tenth of a second";
}

// 50 N/s for at most 0.1 s: a task that was suspended for two seconds must not apply the whole force in one tick.
TEST(SafetyFilter, AfterALongGapAtMostFiveNewtonsComeInAtOnce) {
  SafetyFilter filter({.limit_energy = false}, 0.5);
  static_cast<void>(filter.apply({0, 0, 0}, kRest, kTick));
  EXPECT_NEAR(filter.apply({0, 0, 9}, kRest, 2.0).z, 5.0, 1e-12);
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
  // On its way in, with a position in every third tick: the force is tilted against the motion.
  for (int i = 0; i <= 30; ++i) {
    const double z = -0.1 * (i - i % 3);
    static_cast<void>(filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick));
  }
  filter.reset();
  EXPECT_EQ(filter.apply({0, 0, 0}, {0, 0, -3}, kTick), glm::dvec3(0));
}

TEST(SafetyFilter, WhatComesBeforeAResetIsNoWorkAfterIt) {
  SafetyFilter filter({}, 0.5);
  for (int i = 0; i < 40; ++i) static_cast<void>(filter.apply({0, 0, 1}, kRest, kTick));
  const double scene = filter.books().sceneMj(), artefact = filter.books().artefactMj();
  filter.reset();
  static_cast<void>(filter.apply({0, 0, 0}, {0, 0, 100}, kTick));
  EXPECT_EQ(filter.books().sceneMj(), scene);
  EXPECT_EQ(filter.books().artefactMj(), artefact) << "1 N over 100 mm would be 100 mJ";
}

TEST(SafetyFilter, LeaningIsWithinTheForceAndTheSlewToo) {
  for (const int seed : {1, 2, 3}) {
    constexpr double kMost = 1.5;
    SafetyFilter filter({.force_n = kMost}, 0.5);
    std::mt19937 random(seed);
    std::normal_distribution<double> step(0, 0.3);
    glm::dvec3 hip(0), sent(0);
    bool leant_at_the_limit = false;
    for (int i = 0; i < 5000; ++i) {
      const glm::dvec3 next(hip.x + step(random), hip.y, std::clamp(hip.z + step(random), -5.0, 1.0));
      const glm::dvec3 wanted(0, 0, std::max(-0.5 * next.z, 0.0));
      const glm::dvec3 force = filter.apply(wanted, next, kTick);
      ASSERT_LE(glm::length(force), kMost + 1e-12) << i;
      if (i > 0) {
        ASSERT_LE(glm::distance(force, sent), 0.5 * glm::distance(next, hip) + 50 * kTick + 1e-12) << i;
      }
      leant_at_the_limit = leant_at_the_limit || (wanted.z > kMost && force.x != 0);
      hip = next;
      sent = force;
    }
    EXPECT_TRUE(leant_at_the_limit);
  }
}

// In and out of a wall of 0.5 N/mm, 5 mm deep, as a cosine of time: on this closed path a spring does no net work. The
// device has a new position in every n-th tick, or alternately after one tick and after n.
struct Readings {
  int every = 1;
  bool in_turns = false;
};
double heldWorkOnAWall(const SafetyLimits& limits, double top_speed_mm_per_s, Readings readings = {}, int cycles = 1,
                       double tick_s = kTick) {
  SafetyFilter filter(limits, 0.5);
  const double period = 5 * std::numbers::pi / top_speed_mm_per_s;
  const int ticks = static_cast<int>(std::lround(period / tick_s));
  double work = 0, z = 0, read = 0, force = filter.apply({}, {0, 0, 0}, tick_s).z;
  int since = 0, wait = 1;
  for (int i = 1; i <= cycles * ticks; ++i) {
    const double next = -2.5 * (1 - std::cos(2 * std::numbers::pi * i / ticks));
    work += force * (next - z);
    z = next;
    if (++since >= wait) {
      read = z;
      since = 0;
      wait = readings.in_turns && wait > 1 ? 1 : readings.every;
    }
    force = filter.apply({0, 0, -0.5 * read}, {0, 0, read}, tick_s).z;
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

TEST(SafetyFilter, ADeviceThatRepeatsItsPositionsGivesNoEnergyEither) {
  for (const Readings readings : {Readings{2}, Readings{3}, Readings{2, true}, Readings{3, true}}) {
    for (const double speed : {20.0, 100.0}) {
      EXPECT_GT(heldWorkOnAWall({.limit_energy = false}, speed, readings, 10), 0.015 * speed)
          << "more than once a tick";
      EXPECT_LE(heldWorkOnAWall({}, speed, readings, 10), 0.05) << readings.every << ' ' << speed;
      EXPECT_GE(heldWorkOnAWall({}, speed, readings, 10), -0.02 * 62.5) << readings.every << ' ' << speed;
    }
  }
  EXPECT_LE(heldWorkOnAWall({}, 100, {8}, 10, kTick / 8), 0.05) << "8 kHz on a device of 1 kHz";
}

TEST(SafetyFilter, AFingerThatStopsIsLeantAgainstNoLonger) {
  SafetyFilter filter({}, 0.5);
  for (const int every : {1, 3}) {
    double z = 0;
    for (int i = 0; i < 60; ++i) {
      if (i % every == 0) z -= 0.05;
      static_cast<void>(filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick));
    }
    for (int i = 0; i < 3 * every; ++i) static_cast<void>(filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick));
    EXPECT_NEAR(filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick).z, -0.5 * z, 1e-12) << every;
    // One step after a long rest.
    for (int i = 0; i < 100; ++i) static_cast<void>(filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick));
    z -= 0.05;
    EXPECT_GT(filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick).z, -0.5 * z + 1e-6) << "leant against";
    for (int i = 0; i < 3; ++i) static_cast<void>(filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick));
    EXPECT_NEAR(filter.apply({0, 0, -0.5 * z}, {0, 0, z}, kTick).z, -0.5 * z, 1e-12) << every;
    filter.reset();
  }
}

TEST(SafetyFilter, LeansAgainstTheMotionByNoMoreThanTheSpringOfTwoTicks) {
  SafetyFilter filter(
      {.tank_mj = 1e9},
      0.5);  // the tank never empties: this walk is so wild that tilting the force cannot recover the energy
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

// A wall that comes and goes every 40 ms pushes the hand on after it has gone.
TEST(SafetyFilter, AWallThatLeapsAgainAndAgainPumpsNoMoreThanItsTank) {
  constexpr double kSeconds = 20;
  const auto pumped = [&](const SafetyLimits& limits) {
    SafetyFilter filter(limits, 0.5);
    double z = 0, least = 1, pumped_mj = 0;
    for (int i = 0; i < 1000 * kSeconds; ++i) {
      const bool there = i / 40 % 2 == 0;
      const double moved = there ? -0.05 : 0.1;  // the hand goes where it is pushed, and comes back against the wall
      const double force = filter.apply({0, 0, there ? 4.0 : 0.0}, {0, 0, z += moved}, kTick).z;
      if (!there) pumped_mj += std::max(force * moved, 0.0);
      least = std::min(least, filter.share());
    }
    EXPECT_EQ(least < 0.5, limits.tank_mj < 1e6);
    return pumped_mj;
  };
  const SafetyLimits limits;
  const double most = 2 * limits.tank_mj + limits.tank_mj_per_s * kSeconds;
  EXPECT_GT(pumped({.tank_mj = 1e9}), 2 * most) << "is it hostile?";
  EXPECT_LE(pumped(limits), 1.02 * most) << "but for what leaning adds";
}

TEST(SafetyFilter, ACutLeavesTheTankHalfFull) {
  SafetyFilter filter({}, 0.5);
  double z = 0;
  for (int i = 0; i < 500; ++i) {
    static_cast<void>(filter.apply({0, 0, i < 200 ? 2.0 : 0.0}, {0, 0, z += 0.1}, kTick));
    ASSERT_EQ(filter.share(), 1) << i;
  }
}

TEST(SafetyFilter, AnEmptyTankLeavesTheEndsOfTheWorkspaceFirm) {
  SafetyFilter filter({.tank_mj = 1e-9, .tank_mj_per_s = 0}, 0.5);
  glm::dvec3 force(0);
  for (int i = 0; i < 300; ++i)
    force = filter.apply({0, 0, i % 100 < 50 ? 4.0 : 0.0}, {0, 0, 0.1 * std::min(i, 200)}, kTick, {0.4, 0, 0});
  EXPECT_EQ(filter.share(), 0);
  EXPECT_NEAR(glm::distance(force, {0.4, 0, 0}), 0, 1e-9);
}

TEST(EnergyBooks, AStillWallTakesNothingFromTheSceneAndGivesHalfKDxSquaredPerHeldTick) {
  // In and out of a wall of K = 0.5 N/mm in steps of 0.1 mm, 2 mm deep, without friction. The exact work over the
  // closed path is zero. Because the force is held over the tick, each step in or out gives the hand K dx^2/2: 40
  // steps, 40 x 0.0025 mJ.
  EnergyBooks books(0.5);
  const auto tick = [&](double depth) {
    const glm::dvec3 force(0, 0, 0.5 * depth);
    books.tick({0, 0, -depth}, force, force, force, kTick);
  };
  for (int i = 0; i <= 20; ++i) tick(0.1 * i);
  for (int i = 19; i >= 0; --i) tick(0.1 * i);
  EXPECT_NEAR(books.sceneMj(), 0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 40 * 0.5 * 0.5 * 0.01, 1e-9);
}

TEST(EnergyBooks, APositionThatComesEveryThirdTickIsAWayOfThreeTicks) {
  // The finger moves in steadily and is read every 0.3 mm: between readings the force of the last reading is held.
  EnergyBooks books(0.5);
  for (int i = 0; i <= 30; ++i) {
    const double depth = 0.1 * (i - i % 3);
    const glm::dvec3 force(0, 0, 0.5 * depth);
    books.tick({0, 0, -depth}, force, force, force, kTick);
  }
  EXPECT_NEAR(books.artefactMj(), 10 * 0.5 * 0.5 * 0.09, 1e-9);
  // A force sent in between counts by the time that it is held.
  EnergyBooks leant(0.5);
  const double sent[] = {0.2, 0.4, 0.9};
  for (int i = 0; i <= 3; ++i) {
    leant.tick({0, 0, i == 3 ? -0.3 : 0}, {}, {}, {0, 0, sent[i % 3]}, i == 3 ? 2 * kTick : kTick);
  }
  EXPECT_NEAR(leant.artefactMj(), -0.3 * (0.2 + 0.4 + 2 * 0.9) / 4, 1e-9);
}

TEST(EnergyBooks, AFingerThatHasRestedHasNotBeenOnItsWay) {
  // For a second 2 N are sent to a resting finger, then 0; the 0.1 mm that it then moves are not work of the 2 N.
  EnergyBooks books(0.5);
  for (int i = 0; i < 1000; ++i) books.tick({0, 0, 0}, {}, {}, {0, 0, i < 960 ? 2.0 : 0.0}, kTick);
  books.tick({0, 0, 0.1}, {}, {}, {}, kTick);
  EXPECT_EQ(books.artefactMj(), 0);
}

// An unwanted force of 5 N over 10 mm is 50 mJ. The filter must not take that much back from the hand.
TEST(EnergyBooks, OfAJumpsEnergyNoMoreThanAMillijouleStaysOpen) {
  EnergyBooks books(0.5);
  books.tick({0, 0, 0}, {}, {}, {0, 0, 5}, kTick);
  books.tick({0, 0, 10}, {}, {}, {}, kTick);
  EXPECT_NEAR(books.artefactMj(), 50, 1e-9);
  EXPECT_NEAR(books.openArtefactMj(), EnergyBooks::kMostOpenMj, 1e-12);
}

TEST(EnergyBooks, AWayOfNoTimeIsBookedWithTheForceThatWasSent) {
  EnergyBooks books(0.5);
  books.tick({0, 0, 0}, {}, {}, {0, 0, 2}, kTick);
  books.tick({0, 0, 0.1}, {}, {}, {}, 0);
  EXPECT_NEAR(books.artefactMj(), 0.2, 1e-12);
}

// The first interval after a reset begins with the force wanted after it, not with the one before it.
TEST(EnergyBooks, TheFirstTickAfterAResetBeginsAWay) {
  EnergyBooks books(0.5);
  const glm::dvec3 push(0, 0, 1), none(0);
  books.tick({0, 0, 0}, none, none, none, kTick);
  books.reset();
  books.tick({0, 0, 0}, push, push, push, kTick);
  books.tick({0, 0, 0.1}, push, push, push, kTick);
  EXPECT_NEAR(books.artefactMj(), 0, 1e-12) << "1 N was wanted, sent and held";
}

TEST(EnergyBooks, ARisingSurfaceIsBookedToTheScene) {
  // The surface rises 2 mm through a still finger: the spring is loaded with K d^2/2 = 1 mJ.
  EnergyBooks books(0.5);
  for (int i = 0; i <= 200; ++i) {
    const glm::dvec3 force(0, 0, 0.5 * 0.01 * i);
    books.tick({0, 0, 0}, force, force, force, kTick);
  }
  EXPECT_NEAR(books.sceneMj(), 1.0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 0, 1e-12);
}

TEST(EnergyBooks, SlidingAlongAStillSlopeIsNoWork) {
  EnergyBooks books(0.5);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.3, 0, 1)), along = glm::normalize(glm::dvec3(1, 0, 0.3));
  for (int i = 0; i <= 100; ++i) books.tick(0.1 * i * along, 1.5 * normal, 1.5 * normal, 1.5 * normal, kTick);
  EXPECT_NEAR(books.sceneMj(), 0, 1e-9);
  EXPECT_NEAR(books.artefactMj(), 0, 1e-9);
}

}  // namespace
}  // namespace relievo
