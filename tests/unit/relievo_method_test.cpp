// SPDX-License-Identifier: Apache-2.0
// The default method: contact with what rises, sinks, is cut and is rubbed against.
#include "app/haptics/relievo_method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "app/haptics/shots.h"
#include "tests/support/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr int kCols = 240, kRows = 162;
constexpr double kPeriod = 1.0 / 30, kTick = 0.001, kStiffness = 0.5;

static_assert(sizeof(RelievoMethod) <= 64 * 1024, "the method's own state");

// A film in memory, and a method that is given it tick by tick as the player would.
class RelievoMethodTest : public testing::Test {
 protected:
  using Height = std::function<double(double x, double y, double t)>;
  void film(double seconds, const Height& height, double depth_mm = 40) {
    DisplayVolume volume = kVolume;
    volume.depth_mm = depth_mm;
    for (int k = 0; k * kPeriod <= seconds; ++k) {
      frames_.push_back(test::makeReliefFrame(kCols, kRows, volume, mediaTime(k * kPeriod),
                                              [&](double x, double y) { return height(x, y, k * kPeriod); }));
      const Frame& f = frames_.back();
      surfaces_.push_back({HeightField::make(f, {.bits = 16}, volume).value(), f.pts, f.owner});
    }
  }
  Touch tick(double t, const glm::dvec3& hip) {
    const auto now = static_cast<std::ptrdiff_t>(t / kPeriod + 1e-6);
    const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(now - 2, 0);
    const std::ptrdiff_t end = std::min<std::ptrdiff_t>(now + 4, std::ssize(surfaces_));
    std::vector<TimedSurface> seen(surfaces_.begin() + begin, surfaces_.begin() + end);
    if (!seen_.empty() && !seen.empty()) {
      for (const TimedSurface& s : seen_) {
        if (s.time == seen.front().time) seen.front().shot = s.shot;
      }
    }
    shots_.mark(seen);
    seen_ = seen;
    window_.count = static_cast<int>(std::ssize(seen));
    std::copy(seen.begin(), seen.end(), window_.frames.begin());
    const Touch touch = method_.update(hip, window_, mediaTime(t));
    method_.upkeep(window_, mediaTime(t));
    return touch;
  }
  RelievoMethod method_{{.stiffness_n_per_mm = kStiffness}};
  std::vector<Frame> frames_;
  std::vector<TimedSurface> surfaces_, seen_;
  ShotFinder shots_;
  SurfaceWindow window_;
};

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
        angle = std::abs(std::remainder(speed * kTick * (i - 20) / 50 + 0.8, 1.6)) - 0.4;  // there and back
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
    SetUp();
    frames_.clear();
    surfaces_.clear();
    seen_.clear();
    shots_.forget();
    ++window_.epoch;
    method_.reset();
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

TEST_F(RelievoMethodTest, DoesNotPassAThinRidge) {
  // 3 mm wide and 10 mm high; the finger is pressed against its side and then beyond it.
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

TEST_F(RelievoMethodTest, AFastFingerDoesNotJumpOverARidgeUnseen) {
  film(0.1, [](double x, double, double) { return 10 + 12 * std::exp(-std::pow(x / 0.8, 2)); });
  for (double start = -5; start < -1; start += 0.31) {
    method_.reset();
    static_cast<void>(tick(0, {start, 0, 14}));
    EXPECT_TRUE(tick(kTick, {start + 5, 0, start + 5 > -0.5 && start + 5 < 0.5 ? 14 : 13}).contact) << start;
  }
}

TEST_F(RelievoMethodTest, AWallThatHasGoneOverTheFingerDoesNotTakeTheProxyAlong) {
  // A block of 15 mm comes from the left at 150 mm/s and goes on to the right; the finger rests in its way.
  film(1, [](double x, double, double t) { return x > -50 + 150 * t - 60 && x < -50 + 150 * t ? 25.0 : 10.0; });
  static_cast<void>(tick(0, {0, 0, 30}));
  double furthest = 0;
  int pushed = 0;
  for (int i = 1; i < 700; ++i) {
    const Touch touch = tick(i * kTick, {0, 0, 17});
    furthest = std::max(furthest, glm::distance(touch.proxy_mm, glm::dvec3(0, 0, 17)));
    if (touch.contact) ++pushed;
  }
  EXPECT_LT(furthest, 8 + 3 + 1) << "up is 8 mm";
  EXPECT_GT(pushed, 300) << "and it is pushed all the while that it is inside";
}

TEST_F(RelievoMethodTest, ACutUpIsFeltAtOnceAtNoMoreForceAndComesToItsPlaceAsTheFingerLifts) {
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
  // It lifts at 40 mm/s and is pushed no harder on its way; from the true surface on it is the true surface.
  double z = 10;
  for (int i = 500; z < 29; ++i, z += 0.04) ASSERT_LE(glm::length(tick(i * kTick, {0, 0, z}).force_n), before + 1e-6);
  static_cast<void>(tick(1.3, {0, 0, 29}));
  EXPECT_NEAR(glm::length(tick(1.301, {0, 0, 26}).force_n), 2 * kStiffness / std::hypot(1, 0.2), 0.01);
}

TEST_F(RelievoMethodTest, ACutDownLetsTheFingerGoAndTheNewSurfaceIsThere) {
  const double cut = 10 * kPeriod;
  film(1, [&](double, double, double t) { return t < cut - 1e-6 ? 28.0 : 12.0; });
  static_cast<void>(tick(0, {0, 0, 29}));
  for (int i = 1; i < 333; ++i) ASSERT_TRUE(tick(i * kTick, {0, 0, 26}).contact) << i;
  for (int i = 334; i < 400; ++i) ASSERT_FALSE(tick(i * kTick, {0, 0, 26}).contact) << i;
  EXPECT_NEAR(tick(0.4, {0, 0, 10}).force_n.z, 1, 1e-3);
}

TEST_F(RelievoMethodTest, AfterASeekTheFingerIsReSeated) {
  film(0.5, [](double, double, double t) { return t < 0.2 ? 12.0 : 28.0; });
  static_cast<void>(tick(0, {0, 0, 13}));
  EXPECT_NEAR(tick(kTick, {0, 0, 10}).force_n.z, 1, 1e-3);
  ++window_.epoch;
  shots_.forget();
  const Touch touch = tick(0.4, {0, 0, 10});
  EXPECT_TRUE(touch.contact);
  EXPECT_NEAR(touch.force_n.z, 1, 1e-2);
}

TEST_F(RelievoMethodTest, ASurfaceThatComesBackIsFeltAsItWas) {
  film(0.2, [](double, double, double) { return 20.0; });
  static_cast<void>(tick(0, {0, 0, 21}));
  EXPECT_NEAR(tick(0.001, {0, 0, 17}).force_n.z, 1.5, 1e-3);
  const SurfaceWindow none;
  for (int i = 2; i < 40; ++i) EXPECT_FALSE(method_.update({0, 0, 15}, none, mediaTime(i * kTick)).contact);
  const Touch touch = tick(0.04, {0, 0, 15});
  EXPECT_TRUE(touch.contact);
  EXPECT_NEAR(touch.force_n.z, 1.5, 1e-3) << "not the 2.5 N that its depth would give";
}

TEST_F(RelievoMethodTest, AStillFingerFeelsNoKickAfterACutToABumpyScene) {
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

TEST_F(RelievoMethodTest, OneReadingThatIsNoneLeavesTheFingerWhereItWas) {
  film(0.2, [](double, double, double) { return 20.0; });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  static_cast<void>(tick(0, {0, 0, 21}));
  static_cast<void>(tick(0.001, {0, 0, nan}));
  EXPECT_NEAR(tick(0.002, {0, 0, 15}).force_n.z, 2.5, 1e-3) << "it came in while nobody looked";
}

TEST_F(RelievoMethodTest, FrictionLetsGoOfTheOldSceneAtACut) {
  RelievoMethod rough({.stiffness_n_per_mm = kStiffness, .friction = {0.8, 0.6}});
  const Frame low = test::makeReliefFrame(kCols, kRows, kVolume, {}, [](double, double) { return 12.0; });
  const Frame high = test::makeReliefFrame(kCols, kRows, kVolume, {}, [](double x, double) { return 25 + 0.5 * x; });
  SurfaceWindow w = test::makeWindow(std::span(&low, 1), kVolume);
  static_cast<void>(rough.update({0, 0, 13}, w, {}));
  double before = 0;
  for (int i = 0; i < 50; ++i) before = glm::length(rough.update({0.05 * i, 0, 9}, w, {}).force_n);
  w = test::makeWindow(std::span(&high, 1), kVolume);
  w.epoch = 1;
  EXPECT_LE(glm::length(rough.update({2.45, 0, 9}, w, {}).force_n), before + 1e-3);
}

TEST_F(RelievoMethodTest, ThePapersGuardCanBePutOnTop) {
  RelievoMethod guarded({.stiffness_n_per_mm = kStiffness, .jump_threshold_n = 1});
  const Frame frame = test::makeReliefFrame(kCols, kRows, kVolume, {}, [](double, double) { return 20.0; });
  const SurfaceWindow w = test::makeWindow(std::span(&frame, 1), kVolume);
  static_cast<void>(guarded.update({0, 0, 21}, w, {}));
  EXPECT_TRUE(guarded.update({0, 0, 18.5}, w, {}).contact) << "0.75 N";
  EXPECT_FALSE(guarded.update({0, 0, 16}, w, {}).contact) << "1.25 N more";
  EXPECT_FALSE(guarded.update({0, 0, 16}, w, {}).contact) << "free until it has been outside";
}

TEST_F(RelievoMethodTest, FrictionHoldsUntilTheConeAndThenDrags) {
  RelievoMethod rough({.stiffness_n_per_mm = kStiffness, .friction = {0.5, 0.3}});
  const Frame frame = test::makeReliefFrame(kCols, kRows, kVolume, {}, [](double, double) { return 20.0; });
  const SurfaceWindow w = test::makeWindow(std::span(&frame, 1), kVolume);
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

TEST_F(RelievoMethodTest, AGapInTheFramesOrInThePositionsEndsInTheForceBeforeIt) {
  film(0.5, [](double x, double, double t) { return t < 0.25 ? 12 + 0.1 * x : 24 - 0.1 * x; });
  double before = 0;
  const glm::dvec3 hip(1, 2, 10);
  for (int i = 0; i < 100; ++i) before = glm::length(tick(i * kTick, i < 20 ? glm::dvec3(1, 2, 15) : hip).force_n);
  EXPECT_NEAR(before, kStiffness * 2.1, 0.02);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(tick(100 * kTick, {nan, 0, 0}).contact);
  EXPECT_NEAR(glm::length(tick(101 * kTick, hip).force_n), before, 0.02) << "one position was no number";
  SurfaceWindow empty;
  empty.epoch = window_.epoch;
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(method_.update(hip, empty, mediaTime(0.11)).contact);
  ++window_.epoch;  // sought: 12 mm higher there
  shots_.forget();
  EXPECT_NEAR(glm::length(tick(0.3, hip).force_n), before, 0.02);
}

}  // namespace
}  // namespace relievo
