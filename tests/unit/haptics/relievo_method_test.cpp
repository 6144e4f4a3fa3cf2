// SPDX-License-Identifier: Apache-2.0
// The method on slopes, spheres, ridges and walls: force, contact, friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "tests/support/film/method_stage.h"

namespace relievo {
namespace {

static_assert(sizeof(RelievoMethod) <= 96 * 1024, "the method's own state");

using RelievoMethodTest = test::MethodStage;

TEST_F(RelievoMethodTest, PushesAlongTheNormalWithStiffnessTimesDepth) {
  film(0.3, [](double x, double, double) { return 20 + 0.25 * x; });
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.25, 0, 1));
  for (int i = 0; i < 200; ++i) {
    const double x = -20 + 0.1 * i, depth = std::min(4.0, -1.01 + 0.05 * i);
    const glm::dvec3 place(x, 0.03 * i, 20 + 0.25 * x);
    const Touch touch = tick(i * kTick, place - depth * normal);
    ASSERT_EQ(touch.contact, depth > 0) << i;
    if (depth > 0) {
      ASSERT_LT(glm::distance(touch.force_n, kStiffness * depth * normal), 0.002) << i;
    }
  }
}

TEST_F(RelievoMethodTest, SlidesToTheClosestPointOfASphereAtAnySpeed) {
  const glm::dvec3 centre(0, 0, -20);
  film(0.3, [&](double x, double y, double) { return centre.z + std::sqrt(std::max(2500 - x * x - y * y, 400.0)); });
  for (const double speed : {100.0, 1000.0, 5000.0}) {
    method_.reset();
    double angle = -0.4;
    int ticks = 0;
    double worst = 0;
    for (int i = 0; i < 250; ++i) {
      const glm::dvec3 out(std::sin(angle), 0.2 * std::sin(3 * angle), std::cos(angle));
      const glm::dvec3 direction = glm::normalize(out);
      const Touch touch = tick(i * kTick, centre + direction * (i < 20 ? 51.0 : 45.0));
      if (i >= 20) {
        angle = std::abs(std::remainder(speed * kTick * (i - 20) / 50 + 0.8, 1.6)) - 0.4;  // back and forth
      }
      if (i < 40) continue;
      ASSERT_TRUE(touch.contact) << speed << ' ' << i;
      worst = std::max(worst, glm::distance(touch.force_n, kStiffness * 5 * direction));
      ++ticks;
    }
    EXPECT_GT(ticks, 200);
    EXPECT_LT(worst, speed < 2000 ? 0.02 : 0.6) << speed << " mm/s: at most one tick's way behind";
  }
}

TEST_F(RelievoMethodTest, HoldsContactInEveryTickOfARiseHoweverFast) {
  for (const double speed : {10.0, 100.0, 1000.0, 3000.0}) {
    clear();
    const auto plane = [&](double t) { return 5 + speed * t; };
    film(0.4, [&](double, double, double t) { return plane(t); }, 1500);
    const glm::dvec3 hip(3, 4, 5 + 0.1 * speed);
    for (int i = 0; i < 300; ++i) {
      const Touch touch = tick(i * kTick, hip);
      const double depth = plane(i * kTick) - hip.z;
      if (std::abs(depth) < 0.03) continue;
      ASSERT_EQ(touch.contact, depth > 0) << speed << " mm/s, tick " << i;
      if (depth > 0) {
        ASSERT_NEAR(touch.force_n.z, kStiffness * depth, 0.02) << speed << ' ' << i;
      }
    }
  }
}

TEST_F(RelievoMethodTest, AFingerThatStartsInsideIsFreeUntilItHasComeOut) {
  film(0.4, [](double, double, double) { return 20.0; });
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(tick(i * kTick, {0, 0, 15}).contact);
  for (int i = 50; i < 60; ++i) ASSERT_FALSE(tick(i * kTick, {0, 0, 21}).contact);
  EXPECT_TRUE(tick(0.06, {0, 0, 15}).contact);
}

TEST_F(RelievoMethodTest, NoTickTakesTheProxyFurtherAwayThanStayingWouldHave) {
  // Deep below steep hills the predicted closest point is far off.
  const SurfaceWindow w = picture([](double x, double y) { return 20 + 4 * std::sin(1.1 * x) * std::cos(0.9 * y); });
  std::mt19937 random(1);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int ticks = 0;
  for (int i = 0; i < 1500; ++i) {
    method_.reset();
    glm::dvec3 hip(draw(-20, 20), draw(-15, 15), 30);
    const double deep = draw(8, 19), speed = draw(0.3, 1.5), way = draw(0, 6.3);
    for (; hip.z > deep; hip.z -= 0.2) static_cast<void>(method_.update(hip, w, {}));
    Touch before = method_.update(hip, w, {});
    for (int k = 0; k < 8 && before.contact; ++k) {
      hip += speed * glm::dvec3(std::cos(way), std::sin(way), 0);
      const Touch touch = method_.update(hip, w, {});
      // Half a pitch of the narrow level, the surface's own sampling, is allowed.
      if (touch.contact) {
        ASSERT_LE(glm::distance(touch.proxy_mm, hip), glm::distance(before.proxy_mm, hip) + 0.34) << i << ' ' << k;
        ++ticks;
      }
      before = touch;
    }
  }
  EXPECT_GT(ticks, 5000);
}

TEST_F(RelievoMethodTest, AProxyThatHasFarToGoTakesTicksAndNoneIsLong) {
  // Moving hills, and a finger deep below them that leaps by 12 mm every 40 ms.
  const auto hills = [](double x, double y, double t) {
    return 20 + 4 * std::sin(0.7 * x + 9 * t) * std::cos(0.6 * y - 7 * t);
  };
  const auto normalAt = [&](const glm::dvec3& p, double t) {
    const double h = 1e-4;
    return glm::normalize(glm::dvec3(hills(p.x - h, p.y, t) - hills(p.x + h, p.y, t),
                                     hills(p.x, p.y - h, t) - hills(p.x, p.y + h, t), 2 * h));
  };
  for (const int per_ms : {1, 4}) {  // ticks
    SCOPED_TRACE(per_ms);
    const double tick_s = kTick / per_ms;
    clear();
    make({.stiffness_n_per_mm = kStiffness, .tick_s = tick_s});
    film(2.1, hills);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> draw(0, 2 * std::numbers::pi);
    glm::dvec3 hip(0, 0, 26);
    static_cast<void>(tick(0, hip));
    hip.z = 14;
    std::uint64_t most = 0;
    int cut_short = 0, underway = 0;
    for (int i = 1; i < 2000 * per_ms; ++i) {
      if (i % (40 * per_ms) == 0) {
        const double way = draw(random);
        hip += glm::dvec3(12 * std::cos(way), 12 * std::sin(way), 0);
        if (std::max(std::abs(hip.x), std::abs(hip.y)) > 40) hip = {0, 0, 14};
      }
      const std::uint64_t before = method_.blocksRead();
      const Touch touch = tick(i * tick_s, hip);
      most = std::max(most, method_.blocksRead() - before);
      cut_short += read_by_update_ > mostBlocksOf(tick_s) ? 1 : 0;
      ASSERT_TRUE(touch.contact) << i;
      if (i > 3 * per_ms && i % (40 * per_ms) > 3 * per_ms) {
        const double aligned = glm::dot(glm::normalize(touch.force_n), normalAt(touch.proxy_mm, i * tick_s));
        underway += aligned < std::cos(4 * std::numbers::pi / 180) ? 1 : 0;
      }
    }
    EXPECT_LE(underway, (per_ms > 1 ? 10 : 5) * per_ms)
        << "3 ms after a leap it has arrived; a hill that moves on makes it leap, too";
    // In a frame the wide level needs 6 x 6 blocks without the corners, the narrow one 4 x 4.
    EXPECT_LE(most, mostBlocksOf(tick_s) + 6U * (16 + 32)) << "the last look, at six frames; and then no upkeep";
    EXPECT_GT(cut_short, 10) << "or this would show nothing";
  }
}

TEST_F(RelievoMethodTest, OneReadingThatIsNoneLeavesTheFingerWhereItWas) {
  film(0.2, [](double, double, double) { return 20.0; });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  static_cast<void>(tick(0, {0, 0, 21}));
  static_cast<void>(tick(0.001, {0, 0, nan}));
  EXPECT_NEAR(tick(0.002, {0, 0, 15}).force_n.z, 2.5, 1e-3) << "it came in while nobody looked";
}

TEST_F(RelievoMethodTest, ThePapersGuardCanBePutOnTop) {
  RelievoMethod guarded({.stiffness_n_per_mm = kStiffness, .jump_threshold_n = 1});
  const SurfaceWindow w = picture([](double, double) { return 20.0; });
  static_cast<void>(guarded.update({0, 0, 21}, w, {}));
  EXPECT_TRUE(guarded.update({0, 0, 18.5}, w, {}).contact) << "0.75 N";
  EXPECT_FALSE(guarded.update({0, 0, 16}, w, {}).contact) << "1.25 N more";
  EXPECT_FALSE(guarded.update({0, 0, 16}, w, {}).contact);
  EXPECT_FALSE(guarded.update({0, 0, 19}, w, {}).contact) << "0.5 N, but it has not been outside yet";
  EXPECT_FALSE(guarded.update({0, 0, 21}, w, {}).contact);
  EXPECT_TRUE(guarded.update({0, 0, 19}, w, {}).contact);
}

TEST_F(RelievoMethodTest, FrictionHoldsUntilTheConeAndThenDrags) {
  RelievoMethod rough({.stiffness_n_per_mm = kStiffness, .friction = {0.5, 0.3}});
  const SurfaceWindow w = picture([](double, double) { return 20.0; });
  static_cast<void>(rough.update({0, 0, 21}, w, {}));
  static_cast<void>(rough.update({0, 0, 16}, w, {}));
  double pull = 0;
  for (int i = 1; i <= 60; ++i) {
    const double x = 0.1 * i;
    pull = -rough.update({x, 0, 16}, w, {}).force_n.x;
    if (x < 0.5 * 4 - 0.05) {
      ASSERT_NEAR(pull, kStiffness * x, 1e-3) << "sticks";
    }
  }
  EXPECT_NEAR(pull, 0.3 * 4 * kStiffness, 0.03) << "slides under dynamic friction";
}

TEST_F(RelievoMethodTest, AFingerThatComesDownElsewhereIsNotDraggedBackToWhereFrictionHeldIt) {
  RelievoMethod rough({.stiffness_n_per_mm = kStiffness, .friction = {0.5, 0.3}});
  const SurfaceWindow w = picture([](double, double) { return 20.0; });
  for (const glm::dvec3& hip : {glm::dvec3(0, 0, 21), {0, 0, 16}, {0, 0, 16}, {0, 0, 21}, {10, 0, 21}}) {
    static_cast<void>(rough.update(hip, w, {}));
  }
  EXPECT_NEAR(rough.update({10, 0, 16}, w, {}).force_n.x, 0, 1e-3);
  EXPECT_NEAR(rough.update({10, 0, 16}, w, {}).force_n.x, 0, 1e-3);
}

// 4 mm deep the static cone ends at 2 mm and the dynamic one at 1.2.
TEST_F(RelievoMethodTest, AFingerThatHasSlidIsHeldByStaticFrictionWhenItComesDownAgain) {
  RelievoMethod rough({.stiffness_n_per_mm = kStiffness, .friction = {0.5, 0.3}});
  const SurfaceWindow w = picture([](double, double) { return 20.0; });
  static_cast<void>(rough.update({0, 0, 21}, w, {}));
  for (int i = 0; i <= 60; ++i) static_cast<void>(rough.update({0.1 * i, 0, 16}, w, {}));
  static_cast<void>(rough.update({0, 0, 21}, w, {}));
  static_cast<void>(rough.update({0, 0, 16}, w, {}));
  EXPECT_NEAR(-rough.update({1.6, 0, 16}, w, {}).force_n.x, kStiffness * 1.6, 1e-3) << "sticks";
}

// The box ends at 40 mm; the finger was above it by more than any overshoot of the surface.
TEST_F(RelievoMethodTest, AFingerThatComesFromFarAboveTheBoxInOneTickIsInContact) {
  film(0.1, [](double, double, double) { return 20.0; });
  static_cast<void>(tick(0, {0, 0, 70}));
  const Touch touch = tick(kTick, {0, 0, 18});
  EXPECT_TRUE(touch.contact);
  EXPECT_NEAR(touch.force_n.z, 1, 1e-3);
}

TEST_F(RelievoMethodTest, WhatIsNotAFingerOrNoFilmIsNoContact) {
  film(0.2, [](double, double, double) { return 20.0; });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  static_cast<void>(tick(0, {0, 0, 21}));
  EXPECT_TRUE(tick(0.001, {0, 0, 15}).contact);
  EXPECT_FALSE(tick(0.002, {nan, 0, 15}).contact);
  EXPECT_TRUE(std::isfinite(glm::length(tick(0.003, {1e300, -1e300, 15}).force_n)));
  const SurfaceWindow none;
  EXPECT_FALSE(method_.update({0, 0, 15}, none, {}).contact);
  method_.upkeep(none, {});
}

}  // namespace
}  // namespace relievo
