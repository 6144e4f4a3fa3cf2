// SPDX-License-Identifier: Apache-2.0
// A material per place against closed forms: the force in each region, over the map's edges, at a cut, while the film
// plays; and its energy.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "app/haptics/task/safety.h"
#include "tests/support/film/material_frames.h"
#include "tests/support/film/method_stage.h"

namespace relievo {
namespace {

using test::MaterialCodes;

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr int kCols = 320, kRows = 216;  // of the map: half a millimetre
constexpr double kTick = 0.001, kDeep = 3, kFlat = 20;
constexpr double kSoft = 0.2, kHard = 0.8;
// Full codes: 255 x .004 N/mm, so that codes are whole.
constexpr MaterialCodes kSoftCodes{50, 51, 0}, kHardCodes{200, 204, 102};
const Material kFull{.stiffness_n_per_mm = 255 * 0.004, .friction = {}, .texture = {}};

using Codes = std::function<MaterialCodes(double x, double y)>;
MaterialCodes halves(double x, double) {
  return x < 0 ? kSoftCodes : kHardCodes;
}

SurfaceWindow plane(const Codes& codes, double z_mm = kFlat, MediaTime time = {}) {
  const Frame frame = test::makeReliefFrame(240, 162, kVolume, time, [&](double, double) { return z_mm; });
  SurfaceWindow window = test::makeWindow(std::span(&frame, 1), kVolume);
  window.frames[0].material = test::materialOf(kCols, kRows, kVolume, codes);
  return window;
}

RelievoMethod methodOf(const Material& full, double most_n_per_mm = 10) {
  return RelievoMethod({.stiffness_n_per_mm = 0.5, .places = scaleHeldBy(full, {}, most_n_per_mm, 100)});
}

class Finger {
 public:
  Finger(RelievoMethod& method, const SurfaceWindow& window) : method_(method), window_(window) {
    static_cast<void>(to({0, 0, kFlat + 10}));
  }
  glm::dvec3 to(const glm::dvec3& place) {
    const glm::dvec3 force = method_.update(place, window_, {}).force_n;
    method_.upkeep(window_, {});
    given_ += 0.5 * glm::dot(force_ + force, place - place_);
    force_ = force;
    place_ = place;
    return force;
  }
  // In steps of .05 mm.
  glm::dvec3 along(const glm::dvec3& place) {
    const glm::dvec3 from = place_;
    const int steps = std::max(static_cast<int>(glm::distance(from, place) / 0.05), 1);
    for (int i = 1; i <= steps; ++i) static_cast<void>(to(from + (place - from) * (static_cast<double>(i) / steps)));
    return force_;
  }
  glm::dvec3 press(double x, double depth = kDeep) {
    static_cast<void>(along({x, 0, kFlat + 1}));
    return along({x, 0, kFlat - depth});
  }
  [[nodiscard]] double givenMj() const { return given_; }

 private:
  RelievoMethod& method_;
  const SurfaceWindow& window_;
  glm::dvec3 place_{0, 0, kFlat + 20}, force_{0};
  double given_ = 0;
};

TEST(PlaceMaterial, EachRegionHasTheForceOfItsOwnStiffness) {
  auto method = methodOf(kFull);
  const SurfaceWindow w = plane(halves);
  for (const double depth : {0.5, 2.0, 6.0}) {
    Finger finger(method, w);
    EXPECT_NEAR(finger.press(-30, depth).z, kSoft * depth, 1e-3 * depth);
    EXPECT_NEAR(finger.press(30, depth).z, kHard * depth, 1e-3 * depth);
  }
}

TEST(PlaceMaterial, ADeviceBoundsTheStiffestPlaces) {
  auto method = methodOf(kFull, 0.3);
  const SurfaceWindow w = plane(halves);
  Finger finger(method, w);
  EXPECT_NEAR(finger.press(-30).z, kSoft * kDeep, 1e-3);
  EXPECT_NEAR(finger.press(30).z, 0.3 * kDeep, 1e-3);
}

TEST(PlaceMaterial, WithoutATrackTheWholeFilmsMaterialHolds) {
  auto method = methodOf(kFull), other = methodOf({});
  SurfaceWindow without = plane(halves);
  without.frames[0].material = nullptr;
  const SurfaceWindow with = plane(halves);
  Finger first(method, without), second(other, with);
  EXPECT_NEAR(first.press(30).z, 0.5 * kDeep, 1e-3) << "the track has no picture here";
  EXPECT_NEAR(second.press(30).z, 0.5 * kDeep, 1e-3) << "the track is not read";
}

// What the spring stores stays: k1 d^2/2 = k2 l^2/2, so the force is k2 l = sqrt(k1 k2) d.
TEST(PlaceMaterial, OverAnEdgeTheSpringKeepsItsEnergy) {
  auto method = methodOf(kFull);
  const SurfaceWindow w = plane(halves);
  Finger finger(method, w);
  static_cast<void>(finger.press(-10));
  EXPECT_NEAR(finger.along({10, 0, kFlat - kDeep}).z, std::sqrt(kSoft * kHard) * kDeep, 2e-3);
  EXPECT_NEAR(finger.along({10, 0, kFlat - kDeep - 1}).z, std::sqrt(kSoft * kHard) * kDeep + kHard, 2e-3);
  static_cast<void>(finger.along({10, 0, kFlat - kDeep}));
  EXPECT_NEAR(finger.along({-10, 0, kFlat - kDeep}).z, kSoft * kDeep, 2e-3);
  static_cast<void>(finger.press(10));
  EXPECT_NEAR(finger.along({-10, 0, kFlat - kDeep}).z, kSoft * kDeep, 2e-3);
  EXPECT_NEAR(finger.along({10, 0, kFlat - kDeep}).z, kHard * kDeep, 2e-3) << "what it had put in is there again";
}

TEST(PlaceMaterial, FrictionIsThatOfThePlace) {
  const Material full{.stiffness_n_per_mm = {}, .friction = Friction{0.5, 0.5}, .texture = {}};
  auto method = methodOf(full);
  const SurfaceWindow w = plane(halves);
  Finger finger(method, w);
  const auto drag = [&](double from) {
    static_cast<void>(finger.press(from));
    const glm::dvec3 force = finger.along({from + 20, 0, kFlat - kDeep});
    return -force.x / force.z;
  };
  EXPECT_NEAR(drag(-40), 0.1, 0.002);
  EXPECT_NEAR(drag(20), 0.4, 0.008);
}

TEST(PlaceMaterial, TextureIsThatOfThePlace) {
  const Material full{.stiffness_n_per_mm = {}, .friction = {}, .texture = Texture{0.25, 2}};
  auto method = methodOf(full);
  const SurfaceWindow w = plane(halves);
  Finger finger(method, w);
  const auto swing = [&](double from) {
    static_cast<void>(finger.press(from));
    double least = 1e9, most = -1e9;
    for (double x = from; x < from + 20; x += 0.05) {
      const double force = finger.to({x, 0, kFlat - kDeep}).z;
      if (x < from + 4) continue;
      least = std::min(least, force);
      most = std::max(most, force);
    }
    return 0.5 * (most - least);
  };
  EXPECT_NEAR(swing(20), 0.5 * 0.1, 0.05 * 0.5 * 0.1);
  EXPECT_LT(swing(-40), 1e-3);
}

// The spring is short where a soft place turns stiff, and a trough is no deeper than the spring is long.
TEST(PlaceMaterial, NoRipplePullsWhereASoftPlaceTurnsStiff) {
  const Material full{.stiffness_n_per_mm = 255 * 0.004, .friction = {}, .texture = Texture{0.2, 2}};
  auto method = methodOf(full);
  const MaterialCodes soft{5, 0, 255}, stiff{250, 0, 255};
  const SurfaceWindow w = plane([&](double x, double) { return x < 0 ? soft : stiff; });
  Finger finger(method, w);
  static_cast<void>(finger.press(-4, 2));
  for (double x = -4; x < 4; x += 0.05) ASSERT_GE(finger.to({x, x + 4, kFlat - 2}).z, 0) << x;
}

TEST(PlaceMaterial, AStrokeOverTheMapIsGivenNoEnergy) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Material all{
      .stiffness_n_per_mm = kFull.stiffness_n_per_mm, .friction = Friction{0.5, 0.3}, .texture = Texture{0.25, 2}};
  const SurfaceWindow w = plane([](double x, double y) {
    return static_cast<int>(std::floor(x / 4) + std::floor(y / 4)) % 2 != 0 ? kHardCodes : kSoftCodes;
  });
  for (const Material& full : {kFull, all}) {
    for (int n = 0; n < 60; ++n) {
      auto method = methodOf(full);
      Finger finger(method, w);
      const double seconds = 0.5 + 0.3 * unit(random), across = 25 * unit(random), wave = 3 + 2 * unit(random);
      for (int i = 0; i * kTick <= seconds + kTick; ++i) {
        const double share = std::min(i * kTick / seconds, 1.0), round = std::sin(M_PI * share);
        static_cast<void>(finger.to({across * std::sin(wave * share), 7 * std::cos(2 * wave * share),
                                     kFlat + 1 - 4 * round * (1 + 0.4 * std::sin(9 * share))}));
      }
      EXPECT_EQ(finger.to({0, 0, kFlat + 5}), glm::dvec3(0));
      EXPECT_LT(finger.givenMj(), 0.01) << n;
    }
  }
}

// Through the limits: what the hand changes is free, what the map and the film change passes at 50 N/s.
TEST(PlaceMaterial, EdgesAndCutsChangeTheForceNoFasterThanTheSlewLimit) {
  const Material all{.stiffness_n_per_mm = kFull.stiffness_n_per_mm, .friction = Friction{0.5, 0.3}, .texture = {}};
  auto method = methodOf(all);
  const SafetyLimits limits;
  SafetyFilter safety(limits, *kFull.stiffness_n_per_mm);
  SurfaceWindow w = plane(halves);
  glm::dvec3 last(0), last_hip(-20, 0, kFlat + 1);
  double before_cut = 0, after_cut = 0;
  for (int i = 0; i < 1200; ++i) {
    if (i == 600) {  // another scene, higher and harder
      before_cut = glm::length(last);
      w = plane([](double, double) { return kHardCodes; }, kFlat + 4);
      w.epoch = 1;
    }
    const double x = i < 400 ? -20 + 0.1 * i : 20 - 0.3 * std::min(i - 400, 100);
    const glm::dvec3 hip(x, 0, std::max(kFlat + 1 - 0.05 * i, kFlat - kDeep));
    const glm::dvec3 wanted = method.update(hip, w, {}).force_n;
    method.upkeep(w, {});
    const glm::dvec3 force = safety.apply(wanted, hip, kTick);
    const double by_hand = *kFull.stiffness_n_per_mm * glm::distance(hip, last_hip);
    ASSERT_LE(glm::distance(force, last), by_hand + limits.scene_slew_n_per_s * kTick + 1e-9) << i;
    if (i >= 600 && i < 620) after_cut = std::max(after_cut, glm::length(wanted));
    last = force;
    last_hip = hip;
  }
  EXPECT_GT(before_cut, 0.4);
  EXPECT_LE(after_cut, before_cut + 1e-9) << "a cut gives no more force, however hard the new scene is";
  EXPECT_GT(glm::length(last), 0.3);
}

// A hard thing of 20 mm that moves at 60 mm/s over soft ground, its map with it: a finger that goes along stays on it.
TEST(PlaceMaterial, TheMapStaysOnItsThingWhileTheFilmPlays) {
  constexpr double kPeriod = 1.0 / 30, kSpeed = 60;
  constexpr int kFrames = 6;
  SurfaceWindow w;
  for (int k = 0; k < kFrames; ++k) {
    SurfaceWindow one =
        plane([&](double x, double) { return std::abs(x - kSpeed * kPeriod * k) < 10 ? kHardCodes : kSoftCodes; },
              kFlat, mediaTime(k * kPeriod));
    w.frames[static_cast<std::size_t>(w.count++)] = one.frames[0];
  }
  for (const double aside : {-7.0, 0.0, 7.0, 13.0}) {
    auto method = methodOf(kFull);
    for (int i = 0; i * kTick < (kFrames - 1) * kPeriod; ++i) {
      const double t = i * kTick;
      const glm::dvec3 hip(aside + kSpeed * t, 0, i == 0 ? kFlat + 1 : kFlat - kDeep);
      const Touch touch = method.update(hip, w, mediaTime(t));
      method.upkeep(w, mediaTime(t));
      if (i < 2) continue;
      ASSERT_NEAR(touch.force_n.z, (std::abs(aside) < 10 ? kHard : kSoft) * kDeep, 1e-2) << aside << " " << i;
    }
  }
}

TEST(PlaceMaterial, WhatIsReadAheadIsTheMaterialOfTheNextTick) {
  const SurfaceWindow w = plane([](double x, double) {
    const auto code = static_cast<std::uint8_t>(std::clamp(128 + 4 * x, 20.0, 250.0));
    return MaterialCodes{code, code, code};
  });
  const Material all{.stiffness_n_per_mm = 1, .friction = Friction{0.4, 0.4}, .texture = Texture{0.05, 2}};
  auto ahead = methodOf(all), at_once = methodOf(all);
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 hip(20 * std::sin(0.01 * i), 0, std::max(kFlat + 1 - 0.1 * i, kFlat - kDeep));
    const glm::dvec3 force = ahead.update(hip, w, mediaTime(i * kTick)).force_n;
    ahead.upkeep(w, mediaTime(i * kTick));
    EXPECT_LT(glm::distance(force, at_once.update(hip, w, mediaTime(i * kTick)).force_n), 0.01) << i;
  }
}

}  // namespace
}  // namespace relievo
