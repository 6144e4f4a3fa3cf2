// SPDX-License-Identifier: Apache-2.0
// The default method at discontinuities: cuts, seeks, gaps, and how a lowered surface rises back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/support/film/method_stage.h"

namespace relievo {
namespace {

using RelievoCutTest = test::MethodStage;

TEST_F(RelievoCutTest, ACutUpIsFeltAtOnceAtNoMoreForceAndComesToItsPlaceAsTheFingerLifts) {
  const double cut = 10 * kPeriod;
  film(2, [&](double x, double, double t) { return t < cut - 1e-6 ? 12.0 : 28 + 0.2 * x; });
  double before = 0;
  static_cast<void>(tick(0, {0, 0, 13}));
  for (int i = 1; i < 500; ++i) {
    const Touch touch = tick(i * kTick, {0, 0, 10});
    ASSERT_TRUE(touch.contact) << i;
    const double force = glm::length(touch.force_n);
    if (i * kTick < cut) before = force;
    ASSERT_LE(force, before + 1e-6) << i;
    if (i * kTick > cut + 0.01) {
      ASSERT_GT(force, 0.5 * before) << i << ": the new scene is felt";
    }
  }
  EXPECT_NEAR(before, 1, 1e-3);
  // The finger lifts at 40 mm/s and is never pushed harder; from the true surface on, the true surface is felt.
  double z = 10;
  for (int i = 500; z < 29; ++i, z += 0.04) ASSERT_LE(glm::length(tick(i * kTick, {0, 0, z}).force_n), before + 1e-6);
  static_cast<void>(tick(1.3, {0, 0, 29}));
  EXPECT_NEAR(glm::length(tick(1.301, {0, 0, 26}).force_n), 2 * kStiffness / std::hypot(1, 0.2), 0.01);
}

TEST_F(RelievoCutTest, ACutDownLetsTheFingerGoAndTheNewSurfaceIsThere) {
  const double cut = 10 * kPeriod;
  film(1, [&](double, double, double t) { return t < cut - 1e-6 ? 28.0 : 12.0; });
  static_cast<void>(tick(0, {0, 0, 29}));
  for (int i = 1; i < 333; ++i) ASSERT_TRUE(tick(i * kTick, {0, 0, 26}).contact) << i;
  for (int i = 334; i < 400; ++i) ASSERT_FALSE(tick(i * kTick, {0, 0, 26}).contact) << i;
  EXPECT_NEAR(tick(0.4, {0, 0, 10}).force_n.z, 1, 1e-3);
}

TEST_F(RelievoCutTest, AfterASeekTheFingerIsReSeated) {
  film(0.5, [](double, double, double t) { return t < 0.2 ? 12.0 : 28.0; });
  static_cast<void>(tick(0, {0, 0, 13}));
  EXPECT_NEAR(tick(kTick, {0, 0, 10}).force_n.z, 1, 1e-3);
  ++window_.epoch;
  frames_.clear();
  const Touch touch = tick(0.4, {0, 0, 10});
  EXPECT_TRUE(touch.contact);
  EXPECT_NEAR(touch.force_n.z, 1, 1e-2);
}

TEST_F(RelievoCutTest, ASurfaceThatComesBackIsFeltAsItWas) {
  film(0.2, [](double, double, double) { return 20.0; });
  static_cast<void>(tick(0, {0, 0, 21}));
  EXPECT_NEAR(tick(0.001, {0, 0, 17}).force_n.z, 1.5, 1e-3);
  const SurfaceWindow none;
  for (int i = 2; i < 40; ++i) EXPECT_FALSE(method_.update({0, 0, 15}, none, mediaTime(i * kTick)).contact);
  const Touch touch = tick(0.04, {0, 0, 15});
  EXPECT_TRUE(touch.contact);
  EXPECT_NEAR(touch.force_n.z, 1.5, 1e-3) << "not the 2.5 N that its depth would give";
}

TEST_F(RelievoCutTest, AStillFingerFeelsNoKickAfterACutToABumpyScene) {
  const double cut = 6 * kPeriod;
  film(1, [&](double x, double y, double t) {
    return t < cut - 1e-6 ? 12.0 : 26 + 0.8 * std::sin(1.1 * x) * std::cos(0.9 * y);
  });
  for (const double x : {-7.3, -2.1, 0.4, 3.9, 8.8}) {
    method_.reset();
    glm::dvec3 before(0);
    static_cast<void>(tick(0, {x, 2, 13}));
    for (int i = 1; i < 400; ++i) {
      const Touch touch = tick(i * kTick, {x, 2, 10});
      if (i * kTick > cut + 0.002) {
        ASSERT_LT(glm::distance(touch.force_n, before), 0.1) << x << ' ' << i;
      }
      before = touch.force_n;
    }
  }
}

TEST_F(RelievoCutTest, FrictionLetsGoOfTheOldSceneAtACut) {
  for (const double slope : {0.5, -0.5}) {
    RelievoMethod rough({.stiffness_n_per_mm = kStiffness, .friction = {0.8, 0.6}});
    SurfaceWindow w = picture([](double, double) { return 12.0; });
    static_cast<void>(rough.update({0, 0, 13}, w, {}));
    double before = 0;
    for (int i = 0; i < 50; ++i) before = glm::length(rough.update({0.05 * i, 0, 9}, w, {}).force_n);
    w = picture([slope](double x, double) { return 25 + slope * x; });
    w.epoch = 1;
    const Touch touch = rough.update({2.45, 0, 9}, w, {});
    EXPECT_LE(glm::length(touch.force_n), before + 1e-3) << slope;
    // The finger has not moved on the new scene, so there is no friction: the force is along (-slope, 0, 1).
    EXPECT_NEAR(touch.force_n.x, -slope * touch.force_n.z, 0.02) << slope;
  }
}

// The surface is felt at 12 mm and lies at 28. Friction is a share of what presses on what is felt, 2 mm deep: 1 N.
TEST_F(RelievoCutTest, FrictionOnALoweredSurfaceIsThatOfTheForceThatIsFelt) {
  RelievoMethod rough({.stiffness_n_per_mm = kStiffness, .friction = {0.5, 0.3}});
  SurfaceWindow w = picture([](double, double) { return 12.0; });
  static_cast<void>(rough.update({0, 0, 13}, w, {}));
  static_cast<void>(rough.update({0, 0, 10}, w, {}));
  w = picture([](double, double) { return 28.0; });
  w.epoch = 1;
  Touch touch;
  for (int i = 0; i <= 40; ++i) touch = rough.update({0.1 * i, 0, 10}, w, {});
  EXPECT_NEAR(touch.force_n.z, 1, 0.01);
  EXPECT_NEAR(-touch.force_n.x, 0.3, 0.03);
}

// At the second cut the finger feels 0.5 N, and no more afterwards: the force before the first cut no longer counts.
TEST_F(RelievoCutTest, ASecondCutEndsInTheForceBeforeItAndNotInThatBeforeTheFirst) {
  const auto flat = [](double z) { return picture([z](double, double) { return z; }); };
  SurfaceWindow w = flat(12);
  static_cast<void>(method_.update({0, 0, 13}, w, {}));
  EXPECT_NEAR(method_.update({0, 0, 8}, w, {}).force_n.z, 2, 1e-3);
  w = flat(28);
  w.epoch = 1;
  EXPECT_NEAR(method_.update({0, 0, 8}, w, {}).force_n.z, 2, 1e-3);
  EXPECT_NEAR(method_.update({0, 0, 11}, w, {}).force_n.z, 0.5, 1e-3) << "lifted: the surface is felt at 12 mm";
  w = flat(34);
  w.epoch = 2;
  for (int i = 0; i < 50; ++i) ASSERT_NEAR(method_.update({0, 0, 11}, w, {}).force_n.z, 0.5, 0.051) << i;
}

// 16 mm of lowering belong to the scene that ends.
TEST_F(RelievoCutTest, ACutBackToWhereTheFingerWasIsFeltAsItIs) {
  const auto flat = [](double z) { return picture([z](double, double) { return z; }); };
  SurfaceWindow w = flat(12);
  static_cast<void>(method_.update({0, 0, 13}, w, {}));
  static_cast<void>(method_.update({0, 0, 10}, w, {}));
  w = flat(28);
  w.epoch = 1;
  EXPECT_NEAR(method_.update({0, 0, 10}, w, {}).force_n.z, 1, 1e-3);
  w = flat(12);
  w.epoch = 2;
  const Touch touch = method_.update({0, 0, 10}, w, {});
  EXPECT_TRUE(touch.contact);
  EXPECT_NEAR(touch.force_n.z, 1, 1e-3);
}

TEST_F(RelievoCutTest, AFingerThatHasBeenInsideFromTheBeginningStaysFreeOverACut) {
  const double cut = 3 * kPeriod;
  film(0.4, [&](double, double, double t) { return t < cut - 1e-6 ? 12.0 : 28.0; });
  for (int i = 0; i < 200; ++i) {
    const Touch touch = tick(i * kTick, {0, 0, i < 150 ? 10 : 9});
    ASSERT_FALSE(touch.contact) << i;
    ASSERT_EQ(touch.force_n, glm::dvec3(0)) << i;
  }
  static_cast<void>(tick(0.2, {0, 0, 29}));
  EXPECT_NEAR(tick(0.201, {0, 0, 26}).force_n.z, 1, 1e-3) << "it has been outside";
}

// The surface was felt at 12 mm. After the reset it is where it is, at 28, and a finger at 20 is inside of it.
TEST_F(RelievoCutTest, AResetTakesTheLoweringBack) {
  const double cut = 3 * kPeriod;
  film(0.4, [&](double, double, double t) { return t < cut - 1e-6 ? 12.0 : 28.0; });
  static_cast<void>(tick(0, {0, 0, 13}));
  for (int i = 1; i < 150; ++i) static_cast<void>(tick(i * kTick, {0, 0, 10}));
  method_.reset();
  for (int i = 150; i < 200; ++i) ASSERT_FALSE(tick(i * kTick, {0, 0, 20 - 0.1 * (i - 150)}).contact) << i;
}

// A surface lowered by 0.35 mm rises by 0.1 mm a tick. The last step is 0.05 mm, so that it does not end at 0.4 mm.
TEST_F(RelievoCutTest, ALoweredSurfaceComesBackToWhereItIsAndNoFurther) {
  const auto flat = [](double z) { return picture([z](double, double) { return z; }); };
  SurfaceWindow w = flat(12);
  static_cast<void>(method_.update({0, 0, 13}, w, {}));
  EXPECT_NEAR(method_.update({0, 0, 10}, w, {}).force_n.z, 1, 1e-3);
  w = flat(12.35);
  w.epoch = 1;
  EXPECT_NEAR(method_.update({0, 0, 10}, w, {}).force_n.z, 1, 1e-3);
  double force = 0;
  for (int i = 0; i < 20; ++i) force = method_.update({0, 0, 11}, w, {}).force_n.z;
  EXPECT_NEAR(force, kStiffness * 1.35, 1e-3);
}

TEST_F(RelievoCutTest, AGapInTheFramesOrInThePositionsEndsInTheForceBeforeIt) {
  film(0.5, [](double x, double, double t) { return t < 0.25 ? 12 + 0.1 * x : 24 - 0.1 * x; });
  double before = 0;
  const glm::dvec3 hip(1, 2, 10);
  for (int i = 0; i < 100; ++i) before = glm::length(tick(i * kTick, i < 20 ? glm::dvec3(1, 2, 15) : hip).force_n);
  EXPECT_NEAR(before, kStiffness * 2.1, 0.02);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tick(100 * kTick, {nan, 0, 0}).contact);
  EXPECT_NEAR(glm::length(tick(101 * kTick, hip).force_n), before, 0.02) << "one position was NaN";
  SurfaceWindow empty;
  empty.epoch = window_.epoch;
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(method_.update(hip, empty, mediaTime(0.11)).contact);
  ++window_.epoch;  // a seek: the surface there is 12 mm higher
  frames_.clear();
  EXPECT_NEAR(glm::length(tick(0.3, hip).force_n), before, 0.02);
}

TEST_F(RelievoCutTest, ALoweredSurfaceComesBackInTheSameTimeAtAnyRate) {
  const double cut = 10 * kPeriod;
  for (const double tick_s : {kTick, kTick / 8}) {
    clear();
    film(0.5, [&](double, double, double t) { return t < cut - 1e-6 ? 12.0 : 28.0; });
    make({.stiffness_n_per_mm = kStiffness, .tick_s = tick_s});
    const auto hold = [&](double from, double until, double z) {
      double force = 0;
      for (auto i = std::lround(from / tick_s); i < std::lround(until / tick_s); ++i) {
        force = tick(static_cast<double>(i) * tick_s, {0, 0, z}).force_n.z;
      }
      return force;
    };
    static_cast<void>(hold(0, 0.001, 13));
    EXPECT_NEAR(hold(0.001, 0.4, 10), 1, 1e-3) << "as before the cut";
    // The finger lifts by 1 mm at once, 0.5 N less; then the scene adds 50 N/s, up to the previous force.
    EXPECT_NEAR(hold(0.4, 0.405, 11), 0.75, 0.051) << tick_s;
    const double back = hold(0.405, 0.43, 11);
    EXPECT_NEAR(back, 1, 0.051) << tick_s;
    EXPECT_LE(back, 1 + 1e-3);
  }
}

TEST_F(RelievoCutTest, UnderAFingerThatHasComeFreeTheSurfaceIsBackAtOnce) {
  const double cut = 10 * kPeriod;
  film(0.6, [&](double, double, double t) { return t < cut - 1e-6 ? 12.0 : 28.0; });
  static_cast<void>(tick(0, {0, 0, 13}));
  for (int i = 1; i < 400; ++i) static_cast<void>(tick(i * kTick, {0, 0, 10}));
  EXPECT_FALSE(tick(0.400, {0, 0, 20}).contact) << "the surface is felt at 12 mm";
  EXPECT_NEAR(tick(0.401, {0, 0, 19}).force_n.z, 0.5, 1e-3) << "and now at 20";
  EXPECT_FALSE(tick(0.402, {0, 0, 30}).contact);
  EXPECT_FALSE(tick(0.403, {0, 0, 29}).contact) << "not higher than it is";
  EXPECT_NEAR(tick(0.404, {0, 0, 27}).force_n.z, 0.5, 1e-3);
}

}  // namespace
}  // namespace relievo
