// SPDX-License-Identifier: Apache-2.0
// The method at edges and walls: thin ridges, fast fingers, leaps, walls that sweep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "tests/support/film/method_stage.h"

namespace relievo {
namespace {

using RelievoMethodTest = test::MethodStage;

TEST_F(RelievoMethodTest, DoesNotPassAThinRidge) {
  // 3 mm wide and 10 mm high; the finger presses against its side and then beyond it.
  film(0.6, [](double x, double, double) { return 10 + 10 * std::exp(-std::pow(x / 1.5, 4)); });
  static_cast<void>(tick(0, {-8, 0, 14}));
  bool held = false;
  for (int i = 1; i <= 400; ++i) {
    const Touch touch = tick(i * kTick, {-8 + 0.02 * std::min(i, 390), 0, 14});
    held = held || touch.contact;
    if (i > 350) {
      ASSERT_LT(touch.proxy_mm.x, -0.5) << "still on its own side";
    }
  }
  EXPECT_TRUE(held);
}

// A finger 25 mm below the top is carried out by its wall at 100 mm/s, past a rim that rises above the top.
class SweptOff : public RelievoMethodTest {
 protected:
  // Distance beyond the edge at which the force ends; 20 mm: it has not ended.
  double letGoAt(double rim_mm) {
    film(0.7, [&](double x, double, double) { return x > 0 ? 2.0 : x > -2 ? 35 + rim_mm : 35.0; });
    double x = -25;
    static_cast<void>(tick(0, {x, 0, 36}));
    for (int i = 1; x < 20; ++i) {
      x = -25 + 0.1 * i;
      if (!tick(i * kTick, {x, 0, 10}).contact) return x;
    }
    return x;
  }
};

TEST_F(SweptOff, AHollowAsDeepAsNoiseDoesNotHoldTheProxyBehindTheEdge) {
  const double at = letGoAt(0.5);
  EXPECT_GT(at, -1);
  EXPECT_LT(at, 1) << "mm; it would hold to 2.8";
}

// After its release the finger meets the low floor in the next tick; the point where friction held it is up on the
// edge.
TEST_F(SweptOff, WhatHasFallenOffIsNotDrawnBack) {
  make({.stiffness_n_per_mm = kStiffness, .friction = {0.9, 0.9}});
  film(0.4, [](double x, double, double) { return x > 0 ? 9.0 : 35.0; });
  // Sweeps until the first free tick; returns its force with the finger lower by `dip_mm`.
  const auto sweep = [&](int until, double dip_mm) {
    method_.reset();
    static_cast<void>(tick(0, {-5, 0, 36}));
    for (int i = 1;; ++i) {
      const Touch touch = tick(i * kTick, {-5 + 0.1 * i, 0, i == until ? 10 - dip_mm : 10});
      if (i == until || (i > 1 && !touch.contact)) return std::pair(i, glm::length(touch.force_n));
    }
  };
  const int free = sweep(300, 0).first;
  ASSERT_LT(free, 300);
  const double force_n = sweep(free, 1.2).second;
  EXPECT_GT(force_n, 0);
  EXPECT_LT(force_n, 0.5) << "of a finger .2 mm deep at the foot of a wall";
}

TEST_F(SweptOff, ARidgeHigherThanNoiseHoldsTheProxyBehindTheEdge) {
  EXPECT_EQ(letGoAt(1.5), 20);
}

// A wall two samples thick, and a finger that has pushed through it just below its top.
TEST_F(RelievoMethodTest, AThinWallHoldsTheFingerAlsoNearItsTop) {
  for (double middle = 0.3; middle < 1; middle += 0.17) {
    clear();
    const auto wall = [&](double x) { return 10 + 12 * std::max(0.0, 1 - std::abs(x - middle) / 0.9); };
    film(0.6, [&](double x, double, double) { return wall(x); });
    const SurfaceWindow still = picture([&](double x, double) { return wall(x); });
    FeltSurface felt{FeltScale{}};
    ASSERT_TRUE(felt.moveTo(still, {}));
    const double top = felt.height(middle, 0);
    static_cast<void>(tick(0, {-8, 0, top - 2}));
    double x = -8;
    for (int i = 1; x < 7; ++i) {
      x = -8 + 0.03 * i;
      const Touch touch = tick(i * kTick, {x, 0, top - 2});
      if (x < middle) continue;
      ASSERT_TRUE(touch.contact && touch.proxy_mm.x < middle) << middle << ' ' << x;
    }
  }
}

TEST_F(RelievoMethodTest, AFastFingerDoesNotJumpOverARidgeUnseen) {
  film(0.1, [](double x, double, double) { return 10 + 12 * std::exp(-std::pow(x / 0.8, 2)); });
  for (double start = -5; start < -1; start += 0.31) {
    method_.reset();
    static_cast<void>(tick(0, {start, 0, 14}));
    EXPECT_TRUE(tick(kTick, {start + 5, 0, start + 5 > -0.5 && start + 5 < 0.5 ? 14 : 13}).contact) << start;
  }
}

TEST_F(RelievoMethodTest, ALongGapInTheReadingsDoesNotTakeTheFingerThroughAThinRidge) {
  // One sample wide and 12 mm high; the finger has moved 40 mm between two readings.
  film(0.1, [](double x, double, double) { return std::abs(x - 0.3) < 0.34 ? 22.0 : 10.0; });
  for (double start = -36; start < -8; start += 0.37) {
    method_.reset();
    static_cast<void>(tick(0, {start, 0, 13}));
    EXPECT_TRUE(tick(kTick, {start + 40, 0, 13}).contact) << start;
  }
}

TEST_F(RelievoMethodTest, SkimmingHillsOnItsWayAFingerIsStillCaughtByTheWallBehindThem) {
  const SurfaceWindow w = picture([](double x, double) {
    const double hills = x < -3 ? 2 + 2 * std::cos(2 * std::numbers::pi * x / 6) : 0;
    return x > 0 && x < 3 ? 25.0 : 10 + hills;
  });
  for (double start = -38; start < -20; start += 0.37) {
    method_.reset();
    static_cast<void>(method_.update({start, 0, 20}, w, {}));
    static_cast<void>(method_.update({start, 0, 13.7}, w, {}));
    static_cast<void>(method_.update({4, 0, 13.4}, w, {}));
    for (int rest = 0; rest < 20; ++rest) static_cast<void>(method_.update({4, 0, 13.4}, w, {}));
    EXPECT_TRUE(method_.update({4, 0, 13.4}, w, {}).contact) << start;
  }
}

TEST_F(RelievoMethodTest, AFingerThatRestsDeepInsideAWallStaysAtThatWall) {
  // 9 mm into the wall's side, 5 mm below its top; only the finger moves, then rests, and then strokes along the wall.
  film(0.5, [](double x, double, double) { return x > 0 ? 30.0 : 10.0; });
  static_cast<void>(tick(0, {-6, 0, 25}));
  for (int i = 1; i < 400; ++i) {
    const Touch touch = tick(i * kTick, {std::min(-6 + 0.1 * i, 9.0), 0.1 * std::max(i - 250, 0), 25});
    ASSERT_LT(touch.proxy_mm.x, 1) << i << ' ' << touch.proxy_mm.z;
  }
}

TEST_F(RelievoMethodTest, AFingerThatLeapsInsideARoughWallAndRestsStaysAtThatWall) {
  // Wavy and grainy walls, the finger 5 mm below the top: it pushes 9 mm in, then leaps along the wall, or out and in
  // again in one tick, further than the search follows in a tick, and rests.
  std::mt19937 random(2);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int thrown = 0;
  for (int film_number = 0; film_number < 12; ++film_number) {
    clear();
    const double wave = draw(0.3, 1.2), grain = draw(0, 0.6), pitch = draw(0.8, 3);
    const double grains[] = {draw(5, 9), draw(5, 9), draw(0, 6)};
    film(0.3, [&](double x, double y, double) {
      const double edge = wave * std::sin(pitch * y) + 0.3 * wave * std::sin(2.7 * pitch * y + 1);
      const double rough = grain * std::sin(grains[0] * x + grains[2]) * std::sin(grains[1] * y);
      return (x > edge ? 30.0 : 10.0) + rough;
    });
    int i = 0;
    static_cast<void>(tick(0, {-6, 0, 25}));
    for (double x = -6; x < 9; x += 0.15) static_cast<void>(tick(++i * kTick, {x, 0, 25}));
    double y = 0;
    for (int leap = 0; leap < 5; ++leap) {
      y += draw(3, 8) * (draw(-1, 1) < 0 && y > -20 ? -1 : 1);
      for (int rest = 0; rest < 20; ++rest) {
        const Touch touch = tick(++i * kTick, {9, y, 25});
        ASSERT_TRUE(touch.contact);
        if (touch.proxy_mm.z > 29 && touch.proxy_mm.x > 3) ++thrown;
      }
    }
  }
  EXPECT_EQ(thrown, 0) << "ticks on the top";
}

TEST_F(RelievoMethodTest, AWallThatHasGoneOverTheFingerDoesNotTakeTheProxyAlong) {
  // A block of 15 mm moves from left to right at 80 mm/s; the finger rests in its way.
  film(1, [](double x, double y, double t) {
    const double q = x - 0.3 * y + 45 - 80 * t;
    return q > -60 && q < 0 ? 25.0 : 10.0;
  });
  static_cast<void>(tick(0, {0, 0, 30}));
  double furthest = 0;
  int pushed = 0;
  for (int i = 1; i < 1000; ++i) {
    const Touch touch = tick(i * kTick, {0, 0, 17});
    furthest = std::max(furthest, glm::distance(touch.proxy_mm, glm::dvec3(0, 0, 17)));
    if (touch.contact) ++pushed;
  }
  EXPECT_LT(furthest, 8 + 3 + 1) << "up is 8 mm";
  EXPECT_GT(furthest, 8 + 2) << "but no sooner than that is much the shorter way";
  EXPECT_GT(pushed, 400) << "and it is pushed all the while that it is inside";
}

TEST_F(RelievoMethodTest, AWallThatSweepsOverAFingerThatLeapsDoesNotTakeTheProxyAlong) {
  // The block again, wavy and grainy; every 60 ticks the finger leaps by 5 mm along it, and rests in between.
  film(1, [](double x, double y, double t) {
    const double q = x + 0.8 * std::sin(1.3 * y) + 45 - 80 * t;
    const double rough = 0.4 * std::sin(7 * x) * std::sin(6 * y);
    return (q > -60 && q < 0 ? 25.0 : 10.0) + rough;
  });
  static_cast<void>(tick(0, {0, 0, 30}));
  int carried = 0, pushed = 0;
  for (int i = 1; i < 1000; ++i) {
    const glm::dvec3 hip(0, i / 60 % 2 == 0 ? 0 : 5, 17);
    const Touch touch = tick(i * kTick, hip);
    const bool arrived = i % 60 > 20;
    if (arrived && glm::distance(touch.proxy_mm, hip) > 8 + 3 + 2) ++carried;
    if (touch.contact) ++pushed;
  }
  EXPECT_EQ(carried, 0) << "ticks with the proxy much further away than straight up";
  EXPECT_GT(pushed, 400);
}

}  // namespace
}  // namespace relievo
