// SPDX-License-Identifier: Apache-2.0
// The parts of the default method: weights of frames, block means, the two levels and the clamp, cuts, and the plan.
#include "app/haptics/felt_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>
#include <vector>

#include "app/haptics/edge_motion.h"
#include "app/haptics/shots.h"
#include "app/haptics/touch_plan.h"
#include "tests/support/depth_frames.h"

namespace relievo {
namespace {

using test::makeGrayFrame;
using test::makeReliefFrame;
using test::makeWindow;

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr int kCols = 360, kRows = 243;
constexpr double kPeriod = 1.0 / 30;

template <class Height>
std::vector<Frame> film(int count, Height&& height, int cols = kCols, int rows = kRows) {
  std::vector<Frame> frames;
  for (int k = 0; k < count; ++k) {
    frames.push_back(makeReliefFrame(cols, rows, kVolume, mediaTime(k * kPeriod),
                                     [&](double x, double y) { return height(x, y, k * kPeriod); }));
  }
  return frames;
}

SurfaceWindow emptyFrames(int count) {
  SurfaceWindow w;
  w.count = count;
  for (int k = 0; k < count; ++k) w.frames[static_cast<std::size_t>(k)].time = mediaTime(k * kPeriod);
  return w;
}

double at(const SurfaceWindow& w, TimeLaw law, double t, const std::vector<double>& values) {
  const FrameWeights weights = frameWeights(FrameMoment(w, mediaTime(t)), law);
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0);
}

TEST(FrameWeights, EveryLawGivesALineBackAndTheFittedOneACubic) {
  const SurfaceWindow w = emptyFrames(8);
  std::vector<double> line, cubic;
  const auto c = [](double k) { return 0.3 * k * k * k - 2 * k * k + k; };
  for (int k = 0; k < 8; ++k) {
    line.push_back(3 - 0.5 * k);
    cubic.push_back(c(k));
  }
  for (double k = 2; k < 4.99; k += 0.13) {
    for (const TimeLaw law : {TimeLaw::Linear, TimeLaw::BSpline, TimeLaw::Fitted}) {
      ASSERT_NEAR(at(w, law, k * kPeriod, line), 3 - 0.5 * k, 1e-5) << name(law) << ' ' << k;
    }
    ASSERT_NEAR(at(w, TimeLaw::Fitted, k * kPeriod, cubic), c(k), 1e-4) << k;
    ASSERT_EQ(at(w, TimeLaw::Hold, k * kPeriod, line), 3 - 0.5 * std::floor(k + 1e-9)) << k;
  }
  EXPECT_GT(std::abs(at(w, TimeLaw::BSpline, 3.0 * kPeriod, cubic) - c(3)), 0.1) << "a B-spline smooths";
}

TEST(FrameWeights, AShotsFirstAndLastFramesHoldAndNothingComesFromBeyondACut) {
  SurfaceWindow w = emptyFrames(8);
  for (std::size_t k = 4; k < 8; ++k) w.frames[k].shot = 1;
  const std::vector<double> values{1, 1, 1, 1, 9, 9, 9, 9};
  for (double k = 0; k < 7.9; k += 0.09) {
    for (const TimeLaw law : {TimeLaw::Hold, TimeLaw::Linear, TimeLaw::BSpline, TimeLaw::Fitted}) {
      ASSERT_NEAR(at(w, law, k * kPeriod, values), k + 1e-6 < 4 ? 1 : 9, 1e-5) << name(law) << ' ' << k;
    }
  }
}

TEST(FeltSurface, GivesAMovingPlaneBackExactly) {
  const auto frames = film(6, [](double x, double y, double t) { return 20 + 0.2 * x - 0.1 * y + 30 * t; });
  const SurfaceWindow w = makeWindow(frames, kVolume);
  for (const SpaceLaw space : {SpaceLaw::BSpline, SpaceLaw::Quadratic}) {
    FeltSurface s({.space = space});
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(-50, 50), y(-40, 40), t(2 * kPeriod, 3 * kPeriod);
    for (int i = 0; i < 300; ++i) {
      const double px = x(random), py = y(random), pt = t(random);
      ASSERT_TRUE(s.moment(w, mediaTime(pt)));
      const SurfacePoint p = s.at(px, py);
      ASSERT_NEAR(p.z, 20 + 0.2 * px - 0.1 * py + 30 * pt, 1e-3) << "half a code is 0.0003 mm";
      ASSERT_NEAR(p.zx, 0.2, 1e-3);
      ASSERT_NEAR(p.zy, -0.1, 1e-3);
      ASSERT_NEAR(s.height(px, py), p.z, 1e-5);
    }
  }
}

// Bumps, noise and a step: everything that a derivative could get wrong.
double rough(double x, double y, double t) {
  const double step = x > 10 + 0.3 * y ? 12 : 0;
  return 12 + 3 * std::sin(0.3 * x + 2 * t) * std::cos(0.25 * y) + step + 0.1 * std::sin(57 * x + 91 * y);
}

TEST(FeltSurface, ItsDerivativesAreThoseOfItsHeightAlsoAtAnEdge) {
  const auto frames = film(6, rough);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  FeltSurface s({});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> beside(-1.2, 1.2), y(-10, 10);
  constexpr double kStep = 0.001;
  int off = 0;
  for (int i = 0; i < 2000; ++i) {
    const double py = y(random), px = 10 + 0.3 * py + beside(random);
    ASSERT_TRUE(s.moment(w, mediaTime(0.08)));
    const SurfacePoint p = s.at(px, py), e = s.at(px + kStep, py), o = s.at(px - kStep, py), n = s.at(px, py + kStep),
                       u = s.at(px, py - kStep);
    // The clamp's third derivative jumps, and is large: a difference across the jump is off.
    const auto close = [](double exact, double difference) {
      return std::abs(exact - difference) < 0.02 * (std::abs(exact) + 20);
    };
    ASSERT_NEAR(p.zx, (e.z - o.z) / (2 * kStep), 0.02 * (std::abs(p.zx) + 1)) << px << ' ' << py;
    ASSERT_NEAR(p.zy, (n.z - u.z) / (2 * kStep), 0.02 * (std::abs(p.zy) + 1));
    off += close(p.zxx, (e.zx - o.zx) / (2 * kStep)) ? 0 : 1;
    off += close(p.zxy, (n.zx - u.zx) / (2 * kStep)) ? 0 : 1;
    off += close(p.zyy, (n.zy - u.zy) / (2 * kStep)) ? 0 : 1;
  }
  EXPECT_LT(off, 60) << "of 6000";
}

TEST(FeltSurface, WhatWasPreparedIsWhatWouldHaveBeenComputed) {
  const auto frames = film(8, rough);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  FeltSurface ahead({}), plain({});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(6, 14), y(-10, 10), jitter(-0.0002, 0.0002);
  double t = 0.07;
  for (int i = 0; i < 100; ++i) {
    const double px = x(random), py = y(random), next = t + 0.001;
    ASSERT_TRUE(ahead.moment(w, mediaTime(t)));
    ahead.prepare(w, mediaTime(next), px, py, 2);
    t = next + jitter(random);
    ASSERT_TRUE(ahead.moment(w, mediaTime(t)));
    ASSERT_TRUE(plain.moment(w, mediaTime(t)));
    ASSERT_NEAR(ahead.at(px, py).z, plain.at(px, py).z, 1e-4) << i;
    ASSERT_NEAR(ahead.at(px, py).zx, plain.at(px, py).zx, 1e-3) << i;
  }
}

TEST(FeltSurface, FramesThatComeAndGoAreNotMixedUp) {
  // A plane that goes up 1 mm a frame for 40 frames, the window moving along, frames left out now and then.
  const auto frames = film(40, [](double, double, double t) { return 1 + t / kPeriod * 0.9; }, 90, 61);
  FeltSurface s({});
  std::mt19937 random(4);
  for (int k = 2; k + 5 < 40; k += 1 + static_cast<int>(random() % 3)) {
    const SurfaceWindow w = makeWindow(std::span(frames).subspan(static_cast<std::size_t>(k) - 2, 8), kVolume);
    for (const double share : {0.0, 0.3, 0.9}) {
      const double t = (k + share) * kPeriod;
      ASSERT_TRUE(s.moment(w, mediaTime(t)));
      ASSERT_NEAR(s.at(1.5 * k, 3).z, 1 + (k + share) * 0.9, 2e-3) << k << ' ' << share;
      s.prepare(w, mediaTime(t + 0.001), 1.5 * k + 1, 3, 2);
    }
  }
}

TEST(FeltSurface, HolesAndThePicturesOutsideArePitsAndLoneHolesAreNot) {
  const DepthCalibration holes{.bits = 8, .invalid_code = 0};
  const auto frame = makeGrayFrame(kCols, kRows, 8, {}, [](int c, int r) {
    const bool big = c > 200 && c < 240 && r > 100 && r < 140;
    const bool lone = c == 100 && r == 100;
    return big || lone ? 0 : 128;
  });
  const SurfaceWindow w = makeWindow(std::span(&frame, 1), kVolume, holes);
  FeltSurface s({});
  ASSERT_TRUE(s.moment(w, {}));
  const GridMapping grid(kVolume, kCols, kRows);
  const double level = 128.0 / 255 * 40;
  EXPECT_NEAR(s.height(grid.x(220), grid.y(120)), -40, 1e-4) << "in the hole";
  EXPECT_NEAR(s.height(grid.x(100), grid.y(100)), level, 1e-4) << "a dead pixel";
  EXPECT_NEAR(s.height(grid.x(150), grid.y(50)), level, 1e-4);
  EXPECT_NEAR(s.height(90, 0), -40, 1e-4) << "beside the picture";
  EXPECT_NEAR(s.height(1e9, -1e300), -40, 1e-4) << "far away";
  for (double x = grid.x(195); x < grid.x(245); x += 0.05) {
    const double z = s.height(x, grid.y(120));
    ASSERT_TRUE(z >= -40 - 1e-3 && z <= level + 0.3) << x << ": the rim swings neither up nor down";
  }
}

// Distance of the true upper corner of a 15 mm step to the surface, across the edge at (edge, y).
double cornerError(FeltSurface& s, double edge, double y) {
  double corner = 1e9;
  for (double d = -3; d < 3; d += 0.02) {
    corner = std::min(corner, std::hypot(d / std::hypot(1, 0.3), s.height(edge + d, y) - 25));
  }
  return corner;
}

TEST(FeltSurface, AStepKeepsItsCornerWithinAMillimetreAndFlatGroundIsFlat) {
  const auto frames = film(6, [](double x, double y, double) { return x > 3.07 + 0.3 * y ? 25.0 : 10.0; }, 720, 486);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  FeltSurface s({});
  ASSERT_TRUE(s.moment(w, mediaTime(0.08)));
  for (double y = -15; y < 15; y += 0.7) {
    const double edge = 3.07 + 0.3 * y;
    ASSERT_LE(cornerError(s, edge, y), 0.9) << y;
    ASSERT_NEAR(s.height(edge + 3, y), 25, 0.02);
    ASSERT_NEAR(s.height(edge - 3, y), 10, 0.02);
  }
}

TEST(FeltSurface, AnEdgeThatMovesIsInOnePlaceBetweenTheFrames) {
  for (const double speed : {12.6, 50.0, -50.0}) {
    const auto edge = [&](double y, double t) { return 3.07 + 0.3 * y + speed * t; };
    const auto frames = film(6, [&](double x, double y, double t) { return x > edge(y, t) ? 25.0 : 10.0; }, 720, 486);
    const SurfaceWindow w = makeWindow(frames, kVolume);
    FeltSurface s({});
    for (double t = 2.0 * kPeriod; t < 3 * kPeriod; t += 0.0031) {
      for (const double y : {-7.0, 0.4, 8.0}) {
        ASSERT_TRUE(s.moment(w, mediaTime(t - 0.001)));
        s.prepare(w, mediaTime(t), edge(y, t) + 1, y, 2);
        ASSERT_TRUE(s.moment(w, mediaTime(t)));
        ASSERT_LE(cornerError(s, edge(y, t), y), 0.9) << speed << " mm/s at " << t;
      }
    }
  }
}

TEST(EdgeMotion, FindsTheWayOfAnEdgeAcrossItselfAndNoOther) {
  const auto field = [](const Frame& f) { return HeightField::make(f, {.bits = 16}, kVolume).value(); };
  const auto frame = [](auto&& height) { return makeReliefFrame(720, 486, kVolume, {}, height); };
  const auto step = [&](double at, double lift) {
    return frame([=](double x, double y) { return (x > at + 0.3 * y ? 25.0 : 10.0) + lift + 0.1 * x; });
  };
  const Frame here = step(0, 0), there = step(1.6, 0), lifted = step(0, 1.0), both = step(1.6, 1.0), gone = step(30, 0);
  const glm::dvec2 across = 1.6 / (1 + 0.09) * glm::dvec2(1, -0.3);  // of a sideways way, the part across the edge
  for (const glm::dvec2 place : {glm::dvec2(0.8, 0), glm::dvec2(-1.5, 1), glm::dvec2(2.5, -2)}) {
    const auto way = [&](const Frame& to) { return edgeMotion(field(here), field(to), place.x, place.y); };
    EXPECT_LT(glm::length(way(there) - across), 0.25);
    EXPECT_LT(glm::length(way(both) - across), 0.35) << "also when the whole is lifted by a little";
    EXPECT_EQ(way(here), glm::dvec2(0));
    EXPECT_EQ(way(lifted), glm::dvec2(0)) << "what is lifted has not moved sideways";
    EXPECT_EQ(way(gone), glm::dvec2(0)) << "what is gone has not moved";
  }
  EXPECT_EQ(edgeMotion(field(here), field(there), 40, 0), glm::dvec2(0)) << "no edge in sight";
}

TEST(ShotFinder, FindsCutsAndNoRise) {
  const auto shots = [](auto&& height, int count) {
    const auto frames = film(count, height, 90, 61);
    std::vector<TimedSurface> surfaces;
    for (const Frame& f : frames) {
      surfaces.push_back({HeightField::make(f, {.bits = 16}, kVolume).value(), f.pts, f.owner});
    }
    ShotFinder finder;
    finder.mark(surfaces);
    std::vector<std::uint32_t> numbers;
    for (const TimedSurface& s : surfaces) numbers.push_back(s.shot);
    return numbers;
  };
  const auto cut = [](double x, double y, double t) {
    return t < 3.5 * kPeriod ? 10 + 0.1 * x : 25 - 0.1 * y + 20 * t;
  };
  EXPECT_EQ(shots(cut, 8), (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1}));
  const auto rise = [](double, double, double t) { return std::clamp(900 * (t - 2.5 * kPeriod), 0.0, 40.0); };
  EXPECT_EQ(shots([&](double x, double y, double t) { return rise(x, y, t / 2); }, 8).back(), 0U) << "a fast rise";
  const auto passing = [](double x, double, double t) { return std::abs(x - 300 * t + 40) < 10 ? 30.0 : 10.0; };
  EXPECT_EQ(shots(passing, 8).back(), 0U) << "something passes by";
}

TEST(ShotFinder, ARiseThatEndsIsNoCutWhenTheFrameThatShowedItIsLetGo) {
  const auto frames = film(
      12, [](double, double, double t) { return 10 + 63 * std::clamp(t - 2 * kPeriod, 0.0, 4.2 * kPeriod); }, 90, 61);
  ShotFinder finder;
  std::vector<TimedSurface> held;
  for (const Frame& f : frames) {
    held.push_back({HeightField::make(f, {.bits = 16}, kVolume).value(), f.pts, f.owner});
    if (held.size() > 6) held.erase(held.begin());
    finder.mark(held);
    // The newest pair may yet be taken for a cut: what follows it is not known.
    for (std::size_t i = 0; i + 1 < held.size(); ++i) EXPECT_EQ(held[i].shot, 0U) << toSeconds(f.pts) << ' ' << i;
  }
}

TouchPlan planFor(int bits, double noise_mm, bool moving) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, noise_mm > 0 ? noise_mm : 1e-9);
  std::vector<Frame> frames;
  std::vector<TimedSurface> surfaces;
  const double top = (1 << bits) - 1;
  const GridMapping grid(kVolume, 720, 486);
  for (int k = 0; k < 4; ++k) {
    frames.push_back(makeGrayFrame(720, 486, bits, mediaTime(k * kPeriod), [&](int c, int r) {
      const double z = 18 + 0.2 * grid.x(c) + 2 * std::sin(0.2 * grid.y(r)) + (moving ? 0.5 * k : 0) + noise(random);
      return std::clamp(z / 40, 0.0, 1.0) * top + 0.5;
    }));
    surfaces.push_back(
        {HeightField::make(frames.back(), {.bits = bits}, kVolume).value(), frames.back().pts, frames.back().owner});
  }
  return planTouch(measureClip(surfaces));
}

TEST(TouchPlan, TakesWhatTheClipNeedsAndNoMore) {
  const TouchPlan fine = planFor(16, 0, true), coarse = planFor(8, 0, true), noisy = planFor(8, 0.4, true),
                  still = planFor(8, 0, false);
  EXPECT_LT(fine.scale.wide_mm, 0.3);
  EXPECT_EQ(fine.scale.wide_time, TimeLaw::Fitted);
  EXPECT_NEAR(coarse.measure.quantum_mm, 40.0 / 255, 1e-9);
  EXPECT_EQ(coarse.measure.noise_mm, 0);
  EXPECT_NEAR(coarse.measure.speed_mm_per_s, 15, 5);
  EXPECT_GT(coarse.scale.wide_mm, 0.8);
  EXPECT_NEAR(noisy.measure.noise_mm, 0.4, 0.06);
  EXPECT_EQ(noisy.scale.wide_time, TimeLaw::BSpline);
  EXPECT_GT(noisy.scale.clamp_mm, fine.scale.clamp_mm);
  EXPECT_TRUE(still.measure.still);
  EXPECT_NE(still.scale.wide_time, TimeLaw::Hold) << "a film that begins still may move later";
  // A lead-in of black says nothing: what comes after it may be coarse.
  const Frame black = makeGrayFrame(90, 61, 8, {}, [](int, int) { return 0; });
  const TimedSurface alone{HeightField::make(black, {.bits = 8}, kVolume).value(), {}, black.owner};
  EXPECT_NEAR(planTouch(measureClip(std::span(&alone, 1))).scale.wide_mm, coarse.scale.wide_mm, 1e-9);
  EXPECT_EQ(measureClip({}).frames, 0);
}

TEST(TouchPlan, TellsNoErrorThatItCannotName) {
  const auto told = [](const TouchPlan& plan, const char* part) { return plan.reason.find(part) != std::string::npos; };
  const Frame flat = makeGrayFrame(90, 61, 16, {}, [](int, int) { return 30000; });
  const TimedSurface alone{HeightField::make(flat, {.bits = 16}, kVolume).value(), {}, flat.owner};
  const TouchPlan plan = planTouch(measureClip(std::span(&alone, 1)));
  EXPECT_LT(plan.error, 0.001);
  EXPECT_TRUE(told(plan, "error of the force under 0.1 %")) << plan.reason;
  const TouchPlan coarse = planFor(8, 0, true);
  EXPECT_FALSE(told(coarse, " 0.0 %")) << coarse.reason;
  EXPECT_TRUE(told(coarse, "error of the force about ")) << coarse.reason;
  EXPECT_TRUE(told(coarse, describe(coarse.scale).c_str())) << coarse.reason;
}

}  // namespace
}  // namespace relievo
