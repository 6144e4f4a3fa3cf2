// SPDX-License-Identifier: Apache-2.0
// Friction against closed forms on a plane and a sphere, still and heaving: the force, the cone, sticking and sliding,
// and energy.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <vector>

#include "app/depth_window/touch_plan.h"
#include "tests/support/film/method_stage.h"

namespace relievo {
namespace {

constexpr double kTick = 0.001, kDeep = 4;
constexpr double kRadius = 45, kSlope = 0.25;
const glm::dvec3 kCentre(0, 0, -15);

enum class Shape : std::uint8_t { Plane, Sphere };
enum class Depth : std::uint8_t { Bits16, Bits8, Noise };

double heightOf(Shape shape, double x, double y) {
  if (shape == Shape::Plane) return 20 + kSlope * x;
  return kCentre.z + std::sqrt(std::max(kRadius * kRadius - x * x - y * y, 100.0));
}

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr int kCols = 240 * 3, kRows = 162 * 3;

SurfaceWindow filmOf(Shape shape, Depth depth) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.4);  // 1 % of 40 mm
  const Frame frame = test::makeReliefFrame(kCols, kRows, kVolume, {}, [&](double x, double y) {
    const double z = heightOf(shape, x, y);
    if (depth == Depth::Bits8) return std::round(z / 40 * 255) * 40 / 255;
    return depth == Depth::Noise ? z + noise(random) : z;
  });
  return test::makeWindow(std::span(&frame, 1), kVolume);
}

// The surface at each time, as much higher than the shape.
struct Film {
  static constexpr double kPeriod = 1.0 / 30;
  std::vector<SurfaceWindow> windows;  // of each picture's time; one: a still picture
  double heave_mm = 0;

  [[nodiscard]] double lift(double t) const { return heave_mm * std::sin(2 * M_PI * 0.7 * t); }
  [[nodiscard]] const SurfaceWindow& at(double t) const {
    return windows[std::min(static_cast<std::size_t>(t / kPeriod), windows.size() - 1)];
  }
};
Film still(Shape shape, Depth depth) {
  return {.windows = {filmOf(shape, depth)}};
}
// 3 mm up and down at 0.7 Hz, at up to 13 mm/s.
Film heaving(Shape shape) {
  Film film{.windows = {}, .heave_mm = 3};
  const auto frames = test::makeReliefFilm(26, Film::kPeriod, kCols, kRows, kVolume, [&](double x, double y, double t) {
    return heightOf(shape, x, y) + film.lift(t);
  });
  for (std::size_t now = 0; now + SurfaceWindow::kAhead < frames.size(); ++now) {
    const std::size_t first = now - std::min<std::size_t>(now, SurfaceWindow::kBefore);
    film.windows.push_back(
        test::makeWindow(std::span(frames).subspan(first, now + SurfaceWindow::kAhead + 1 - first), kVolume));
  }
  return film;
}

// A place on the surface after `way_mm` along it, the way's direction there, and the normal.
struct Spot {
  glm::dvec3 at, along, normal;
};
Spot spotAt(Shape shape, double way_mm) {
  if (shape == Shape::Plane) {
    const glm::dvec3 along = glm::normalize(glm::dvec3(1, 0, kSlope)), normal(-along.z, 0, along.x);
    return {glm::dvec3(0, 0, 20) + along * way_mm, along, normal};
  }
  const double angle = way_mm / kRadius;
  const glm::dvec3 out(std::sin(angle), 0, std::cos(angle));
  return {kCentre + kRadius * out, {out.z, 0, -out.x}, out};
}

// The force of a finger kDeep below `spot` that slides along against friction: its spring's end lies behind by the
// angle t on a sphere, for which (R - d) sin t = mu (R - (R - d) cos t).
glm::dvec3 slidingForce(Shape shape, double way_mm, double mu, double stiffness) {
  const Spot spot = spotAt(shape, way_mm);
  const glm::dvec3 hip = spot.at - kDeep * spot.normal;
  if (shape == Shape::Plane) return stiffness * kDeep * (spot.normal - mu * spot.along);
  double low = 0, high = 0.6;
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high), inner = kRadius - kDeep;
    (inner * std::sin(t) > mu * (kRadius - inner * std::cos(t)) ? high : low) = t;
  }
  return stiffness * (spotAt(shape, way_mm - low * kRadius).at - hip);
}

struct Stroke {
  double error = 0;       // rms, as a share of the force
  double cone = 0;        // mean of (force aside)/(force along the normal)
  double cone_worst = 0;  // the furthest from the coefficient, 16 bits
  int transitions = 0;    // between sticking and sliding
};

// Comes in, rests, slides 30 mm at a speed, rests again; on a heaving surface it goes up and down with it.
Stroke stroke(RelievoMethod& method, Shape shape, const Film& film, double mu, double stiffness,
              double speed_mm_per_s) {
  constexpr double kFrom = -15, kRest = 0.15;
  const double sliding = 30 / speed_mm_per_s;
  Stroke result;
  bool slid = false;
  int ticks = 0;
  double squares = 0;
  for (int i = 0; i * kTick < 2 * kRest + sliding; ++i) {
    const double t = i * kTick, way = kFrom + speed_mm_per_s * std::clamp(t - kRest, 0.0, sliding);
    const Spot spot = spotAt(shape, way);
    const double deep = std::min(kDeep, -1 + 0.1 * i);
    const glm::dvec3 lift(0, 0, film.lift(t));
    const Touch touch = method.update(spot.at + lift - deep * spot.normal, film.at(t), mediaTime(t));
    method.upkeep(film.at(t), mediaTime(t));
    result.transitions += method.slides() != slid ? 1 : 0;
    slid = method.slides();
    // Dragging after at most mu d (R - d)/R.
    if (way < kFrom + 6 || t > kRest + sliding) continue;
    const glm::dvec3 truth = slidingForce(shape, way, mu, stiffness);
    squares += std::pow(glm::length(touch.force_n - truth) / glm::length(truth), 2);
    const Spot held = spotAt(shape, way - glm::dot(spot.at + lift - touch.proxy_mm, spot.along));
    const double pressed = glm::dot(touch.force_n, held.normal);
    const double cone = -glm::dot(touch.force_n, held.along) / pressed;
    result.cone += cone;
    if (mu > 0) result.cone_worst = std::max(result.cone_worst, std::abs(cone / mu - 1));
    ++ticks;
  }
  result.cone /= ticks;
  result.error = std::sqrt(squares / ticks);
  return result;
}

RelievoMethod rough(double stiffness, Friction friction) {
  return RelievoMethod({.stiffness_n_per_mm = stiffness, .friction = friction});
}

// For each stiffness and friction. `rests`: the point that holds the finger comes to rest in the end.
void expectClosedForm(Shape shape, const Film& film, bool rests) {
  for (const double stiffness : {0.15, 0.5, 1.0}) {
    RelievoMethod smooth({.stiffness_n_per_mm = stiffness});
    const Stroke without = stroke(smooth, shape, film, 0, stiffness, 100);
    EXPECT_LT(without.error, 0.01);
    EXPECT_EQ(without.transitions, 0);
    for (const double mu : {0.1, 0.3, 0.6}) {
      auto method = rough(stiffness, {1.5 * mu, mu});
      const Stroke with = stroke(method, shape, film, mu, stiffness, 100);
      SCOPED_TRACE(testing::Message() << (shape == Shape::Plane ? "plane " : "sphere ") << stiffness << " " << mu);
      EXPECT_LT(with.error, without.error + 0.01);
      EXPECT_LT(with.cone_worst, 0.02);
      EXPECT_LE(with.transitions, 2) << "it begins to slide, and rests";
      EXPECT_GE(with.transitions, rests ? 2 : 1);
    }
  }
}

TEST(StickPoint, AFingerThatSlidesFeelsTheForceOfTheClosedForm) {
  for (const Shape shape : {Shape::Plane, Shape::Sphere}) expectClosedForm(shape, still(shape, Depth::Bits16), true);
}

// On the cone, where a slide ends, the point creeps by what the surface's motion is off.
TEST(StickPoint, OnAHeavingSurfaceItFeelsTheSameForce) {
  for (const Shape shape : {Shape::Plane, Shape::Sphere}) expectClosedForm(shape, heaving(shape), false);
}

// On the usual widths of smoothing, and on those that the player's plan picks for the depth.
TEST(StickPoint, SlidesWithoutChatterOnEveryKindOfDepth) {
  for (const Shape shape : {Shape::Plane, Shape::Sphere}) {
    for (const Depth depth : {Depth::Bits16, Depth::Bits8, Depth::Noise}) {
      const Film film = still(shape, depth);
      const FeltScale planned = planFilm(std::span(film.windows[0].frames).first(1)).scale;
      for (const double speed : {10.0, 100.0, 500.0}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(shape) << static_cast<int>(depth) << " " << speed);
        auto usual = rough(0.5, {0.3, 0.2});
        EXPECT_EQ(stroke(usual, shape, film, 0.2, 0.5, speed).transitions, 2);
        RelievoMethod method({.stiffness_n_per_mm = 0.5, .scale = planned, .friction = {0.3, 0.2}});
        const Stroke with = stroke(method, shape, film, 0.2, 0.5, speed);
        EXPECT_EQ(with.transitions, 2);
        EXPECT_NEAR(with.cone, 0.2, 0.02 * 0.2);
      }
    }
  }
}

// On a plane the spring's end rests until the finger is mu d aside.
TEST(StickPoint, AFingerThatRestsIsHeldByTheStaticCoefficient) {
  for (const double mu : {0.1, 0.3, 0.6}) {
    auto method = rough(0.5, {mu, 0.5 * mu});
    const SurfaceWindow w = filmOf(Shape::Plane, Depth::Bits16);
    double most = 0, last = 0;
    for (int i = 0; i < 4000; ++i) {
      const Spot spot = spotAt(Shape::Plane, 0.001 * std::max(i - 100, 0));
      const Touch touch = method.update(spot.at - std::min(kDeep, -1 + 0.1 * i) * spot.normal, w, {});
      if (i < 60) continue;
      const double aside = -glm::dot(touch.force_n, spot.along), pressed = glm::dot(touch.force_n, spot.normal);
      ASSERT_NEAR(pressed, 0.5 * kDeep, 0.01 * 0.5 * kDeep);
      last = aside / pressed;
      most = std::max(most, last);
    }
    EXPECT_NEAR(most, mu, 0.02 * mu);
    EXPECT_NEAR(last, 0.5 * mu, 0.02 * 0.5 * mu);
  }
}

// The way back begins with a spring that points forward: it must be turned before the finger slides again.
TEST(StickPoint, AFingerThatTurnsBackIsHeldBeforeItSlidesBack) {
  auto method = rough(0.5, {0.3, 0.2});
  const SurfaceWindow w = filmOf(Shape::Plane, Depth::Bits16);
  double way = -10;
  const auto asideAt = [&](double place) {
    const Spot spot = spotAt(Shape::Plane, place);
    return -glm::dot(method.update(spot.at - kDeep * spot.normal, w, {}).force_n, spot.along) / (0.5 * kDeep);
  };
  static_cast<void>(method.update(spotAt(Shape::Plane, way).at + glm::dvec3(0, 0, 1), w, {}));
  for (; way < 0; way += 0.1) static_cast<void>(asideAt(way));
  for (; way > -1.55; way -= 0.05) EXPECT_NEAR(asideAt(way), 0.2 + way / kDeep - 0.1 / kDeep, 0.012) << way;
  for (; way > -10; way -= 0.05) static_cast<void>(asideAt(way));
  EXPECT_NEAR(asideAt(way), -0.2, 0.004);
}

// Strokes of all kinds: what they give the hand, by the trapezoid rule.
TEST(StickPoint, AStrokeIsGivenNoEnergy) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const Shape shape : {Shape::Plane, Shape::Sphere}) {
    for (const Depth depth : {Depth::Bits16, Depth::Bits8, Depth::Noise}) {
      const SurfaceWindow w = filmOf(shape, depth);
      for (int n = 0; n < 40; ++n) {
        auto method = rough(0.5, {0.3, 0.2});
        const double length = 15 * unit(random), wave = 1 + unit(random), from = 10 * unit(random);
        const double seconds = 0.4 + 0.3 * unit(random);
        double given = 0;
        glm::dvec3 force(0), place(0);
        for (int i = 0; i * kTick <= seconds; ++i) {
          const double share = i * kTick / seconds, round = std::sin(M_PI * share);
          const Spot spot = spotAt(shape, from + length * std::sin(2 * M_PI * wave * share));
          const glm::dvec3 hip = spot.at + (1 - 5 * round) * spot.normal + glm::dvec3(0, 4 * std::sin(9 * share), 0);
          const Touch touch = method.update(hip, w, {});
          if (i > 0) given += 0.5 * glm::dot(force + touch.force_n, hip - place);
          force = touch.force_n;
          place = hip;
        }
        EXPECT_EQ(force, glm::dvec3(0)) << "it has come out";
        EXPECT_LT(given, 0.01) << "mJ, " << static_cast<int>(shape) << static_cast<int>(depth) << " " << n;
      }
    }
  }
}

// After the force is sent, the surface at the stick point is read for the next tick. The result must be that of reading
// it in the next tick itself.
TEST(StickPoint, WhatIsReadAheadIsTheSurfaceOfTheNextTick) {
  constexpr double kRise = 60;  // mm/s
  const auto film = test::makeReliefFilm(7, 1.0 / 30, 240, 162, kVolume, [](double x, double y, double t) {
    return 12 + kRise * t + 0.25 * x + std::sin(0.3 * x) * std::cos(0.2 * y);
  });
  const SurfaceWindow w = test::makeWindow(film, kVolume);
  auto ahead = rough(0.5, {0.3, 0.2}), at_once = rough(0.5, {0.3, 0.2});
  for (int i = 0; i < 150; ++i) {
    const double t = i * kTick, x = -10 + 0.1 * i;
    const double depth = std::min(4.0, -1 + 0.1 * i);
    const glm::dvec3 hip(x, 2, 12 + kRise * t + 0.25 * x + std::sin(0.3 * x) * std::cos(0.4) - depth);
    const glm::dvec3 force = ahead.update(hip, w, mediaTime(t)).force_n;
    ahead.upkeep(w, mediaTime(t));
    EXPECT_LT(glm::distance(force, at_once.update(hip, w, mediaTime(t)).force_n), 0.003) << i;
  }
}

}  // namespace
}  // namespace relievo
