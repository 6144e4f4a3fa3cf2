// SPDX-License-Identifier: Apache-2.0
// The surface of the default method: block means, the two levels and the clamp, edges that move.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <random>
#include <span>
#include <vector>

#include "app/depth_window/shots.h"
#include "app/haptics/method/felt_surface.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/haptics/felt_films.h"

namespace relievo {
namespace {

using test::makeGrayFrame;
using test::makeWindow;

TEST(FeltSurface, GivesAMovingPlaneBackExactly) {
  const auto frames = film(6, [](double x, double y, double t) { return 20 + 0.2 * x - 0.1 * y + 30 * t; });
  const SurfaceWindow w = makeWindow(frames, kVolume);
  for (const SpaceLaw space : {SpaceLaw::BSpline, SpaceLaw::Quadratic}) {
    FeltSurface s({.space = space});
    readAll(s, w, 2.5 * kPeriod);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(-50, 50), y(-40, 40), t(2 * kPeriod, 3 * kPeriod);
    for (int i = 0; i < 300; ++i) {
      const double px = x(random), py = y(random), pt = t(random);
      ASSERT_TRUE(s.moveTo(w, mediaTime(pt)));
      const SurfacePoint p = s.at(px, py);
      ASSERT_NEAR(p.z, 20 + 0.2 * px - 0.1 * py + 30 * pt, 1e-3) << "half a code is 0.0003 mm";
      ASSERT_NEAR(p.zx, 0.2, 1e-3);
      ASSERT_NEAR(p.zy, -0.1, 1e-3);
      ASSERT_NEAR(s.height(px, py), p.z, 1e-5);
    }
  }
}

TEST(FeltSurface, ItsDerivativesAreThoseOfItsHeightAlsoAtAnEdge) {
  const auto frames = film(6, rough);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  FeltSurface s({});
  std::mt19937 random(2);
  std::uniform_real_distribution<double> beside(-1.2, 1.2), y(-10, 10);
  constexpr double kStep = 0.0004;
  int off = 0;
  for (int i = 0; i < 2000; ++i) {
    const double py = y(random), px = 10 + 0.3 * py + beside(random);
    ASSERT_TRUE(s.moveTo(w, mediaTime(0.08)));
    const SurfacePoint p = s.at(px, py), e = s.at(px + kStep, py), o = s.at(px - kStep, py), n = s.at(px, py + kStep),
                       u = s.at(px, py - kStep);
    // A cubic's third derivative jumps between cells, so a difference quotient across such a jump is inexact.
    const auto close = [](double exact, double difference) {
      return std::abs(exact - difference) < 0.02 * (std::abs(exact) + 20);
    };
    ASSERT_NEAR(p.zx, (e.z - o.z) / (2 * kStep), 0.02 * (std::abs(p.zx) + 1)) << px << ' ' << py;
    ASSERT_NEAR(p.zy, (n.z - u.z) / (2 * kStep), 0.02 * (std::abs(p.zy) + 1));
    off += close(p.zxx, (e.zx - o.zx) / (2 * kStep)) ? 0 : 1;
    off += close(p.zxy, (n.zx - u.zx) / (2 * kStep)) ? 0 : 1;
    off += close(p.zyy, (n.zy - u.zy) / (2 * kStep)) ? 0 : 1;
  }
  EXPECT_LT(off, 20) << "of 6000";
}

// The plane that rises by 30 mm/s, of which the window has nothing later than 40 ms before the moment that is felt.
// A B-spline in time is off by a T^2/6: by 1/6 mm. What alternates by .02 mm is left with a third at a frame's time.
TEST(FeltSurface, AdaptedInTimeItFollowsWhatAcceleratesAndSmoothsWhatAlternates) {
  const double bend = 1 / (kPeriod * kPeriod);
  const auto frames = film(8, [&](double x, double, double t) {
    if (x > 0) return 20 + 0.5 * bend * (t - 0.1) * (t - 0.1);
    return std::lround(t / kPeriod) % 2 == 0 ? 20.02 : 19.98;
  });
  const SurfaceWindow w = makeWindow(frames, kVolume);
  FeltSurface s(
      {.narrow_mm = 0.5, .wide_mm = 0.9, .clamp_mm = 2, .wide_steady_mm = 0.02, .wide_time = TimeLaw::Adapted});
  readAll(s, w, 3 * kPeriod, 20, 0);
  readAll(s, w, 3 * kPeriod, -20, 0);
  for (double t = 3 * kPeriod; t < 4 * kPeriod; t += 0.003) {
    ASSERT_TRUE(s.moveTo(w, mediaTime(t)));
    EXPECT_NEAR(s.height(20, 0), 20 + 0.5 * bend * (t - 0.1) * (t - 0.1), 1e-3) << t;
    EXPECT_NEAR(s.height(-20, 0), 20, 0.02 / 3 + 1e-3) << t;
  }
}

TEST(FeltSurface, CarriedForwardAMovingPlaneIsWhereItWillBe) {
  const auto frames = film(4, [](double x, double, double t) { return 15 + 0.2 * x + 30 * t; });
  SurfaceWindow w = makeWindow(frames, kVolume);
  w.carried = std::chrono::milliseconds(40);
  FeltSurface s({.narrow_time = TimeLaw::Linear, .wide_time = TimeLaw::Linear});
  for (double t = 2 * kPeriod; t < 2.9 * kPeriod; t += 0.0013) {
    ASSERT_TRUE(s.moveTo(w, mediaTime(t + 0.04)));
    ASSERT_NEAR(s.at(7, 3).z, 15 + 0.2 * 7 + 30 * (t + 0.04), 1e-3);
    s.prepare(w, mediaTime(t + 0.041), 7, 3);
    ASSERT_TRUE(s.moveTo(w, mediaTime(t + 0.0412)));
    ASSERT_NEAR(s.at(7, 3).z, 15 + 0.2 * 7 + 30 * (t + 0.0412), 1e-3) << "as prepared";
  }
}

// A step of 15 mm moves past. Its edge, carried forward in time, must not raise the surface above the step's top or
// lower it below the ground.
TEST(FeltSurface, CarriedForwardAnEdgeThrowsNothingBeyondItsSides) {
  const auto frames = film(8, [](double x, double, double t) { return x < 60 * (t - 0.1) ? 25 : 10; });
  SurfaceWindow w = makeWindow(frames, kVolume);
  w.carried = std::chrono::milliseconds(33);
  FeltSurface s({.narrow_time = TimeLaw::Linear, .wide_time = TimeLaw::Linear});
  for (double t = 2 * kPeriod; t < 6 * kPeriod; t += 0.0017) {
    ASSERT_TRUE(s.moveTo(w, mediaTime(t) + w.carried));
    for (double x = -12; x < 12; x += 0.3) {
      const double z = s.height(x, 1);
      ASSERT_LE(z, 25 + 2.3) << t << ' ' << x;
      ASSERT_GE(z, 10 - 2.3) << t << ' ' << x;
    }
  }
}

TEST(FeltSurface, HolesAndThePicturesOutsideArePitsAndLoneHolesAreNot) {
  const DepthCalibration holes{.bits = 8, .invalid = 0};
  const auto frame = makeGrayFrame(kCols, kRows, 8, {}, [](int c, int r) {
    const bool big = c > 200 && c < 240 && r > 100 && r < 140;
    const bool lone = c == 100 && r == 100;
    return big || lone ? 0 : 128;
  });
  const SurfaceWindow w = makeWindow(std::span(&frame, 1), kVolume, holes);
  FeltSurface s({});
  ASSERT_TRUE(s.moveTo(w, {}));
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

// Distance of the true upper corner of a 15 mm step from the surface, across the edge at (edge, y).
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
  ASSERT_TRUE(s.moveTo(w, mediaTime(0.08)));
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
        ASSERT_TRUE(s.moveTo(w, mediaTime(t - 0.001)));
        s.prepare(w, mediaTime(t), edge(y, t) + 1, y);
        ASSERT_TRUE(s.moveTo(w, mediaTime(t)));
        ASSERT_LE(cornerError(s, edge(y, t), y), 0.9) << speed << " mm/s at " << t;
      }
    }
  }
}

double edgeAt(double edge_mm, double x) {
  return x < edge_mm ? 30 : 10;
}

// An edge moves to the right from frame to frame, by much or by less than a control point's pitch. A surface that is
// evaluated tick by tick, while the window moves on, must have the edge where a fresh surface has it.
TEST(FeltSurface, WhatIsLeftOfATickDoesNotShowWhereAnEdgeMoves) {
  constexpr double kRampMm = 2;
  constexpr double kX = 0.45;  // from 0.25 to 0.65 mm it depends on the same control points
  for (const double way_mm : {3.0, 0.2}) {
    const auto frames = film(9, [&](double x, double, double t) {
      const double edge = way_mm * (t / kPeriod - 3);
      return 10 + 20 * std::clamp((edge - x) / kRampMm + 0.5, 0.0, 1.0);
    });
    const auto around = [&](double t) {
      const auto present = static_cast<std::size_t>(t / kPeriod + 1e-6), first = present < 2 ? 0 : present - 2;
      return makeWindow(std::span(frames).subspan(first, std::min(present + 5, frames.size()) - first), kVolume);
    };
    FeltSurface walked({});
    readAll(walked, around(kPeriod), kPeriod, kX);
    int beside_the_edge = 0;
    for (double t = kPeriod; t < 5 * kPeriod; t += 0.001) {
      const SurfaceWindow window = around(t), next = around(t + 0.001);
      ASSERT_TRUE(walked.moveTo(window, mediaTime(t)));
      walked.prepare(window, mediaTime(t + 0.001), kX, 0);
      ASSERT_TRUE(walked.moveTo(next, mediaTime(t + 0.001)));
      FeltSurface fresh({});
      readAll(fresh, next, t, kX);
      fresh.prepare(next, mediaTime(t + 0.001), kX, 0);
      ASSERT_TRUE(fresh.moveTo(next, mediaTime(t + 0.001)));
      const double z = fresh.height(kX, 0);
      ASSERT_NEAR(walked.height(kX, 0), z, 0.01) << way_mm << ' ' << t / kPeriod;
      beside_the_edge += z > 11 && z < 29 ? 1 : 0;
    }
    EXPECT_GT(beside_the_edge, 2) << way_mm;
  }
}

// The frame has the time of an earlier one whose edge moved; the edge of this frame does not move.
TEST(FeltSurface, TheMotionOfAnEdgeEndsWithItsEpoch) {
  const auto moving = film(5, [](double x, double, double t) { return edgeAt(-6 + 3 * t / kPeriod, x); });
  const auto standing = film(5, [](double x, double, double) { return edgeAt(0, x); });
  const SurfaceWindow before = makeWindow(moving, kVolume);
  SurfaceWindow after = makeWindow(standing, kVolume);
  after.epoch = 1;
  const double t = 2.5 * kPeriod;
  FeltSurface s({}), fresh({});
  ASSERT_TRUE(s.moveTo(before, mediaTime(t - 0.001)));
  s.prepare(before, mediaTime(t), 0, 0);
  ASSERT_TRUE(s.moveTo(after, mediaTime(t)));
  ASSERT_TRUE(fresh.moveTo(after, mediaTime(t)));
  for (const double x : {-1.5, -0.5, 0.0, 0.5, 1.5}) EXPECT_NEAR(s.height(x, 0), fresh.height(x, 0), 1e-4) << x;
}

// Beyond the cut there is an edge 2 mm further on, which is not the same edge.
TEST(FeltSurface, AnEdgeDoesNotMoveOverACut) {
  const auto frames = film(5, [](double x, double, double t) { return edgeAt(t < 2.5 * kPeriod ? 0 : 2, x); });
  SurfaceWindow window = makeWindow(frames, kVolume);
  window.frames[3].shot = window.frames[4].shot = 1;
  const double t = 2.5 * kPeriod;
  FeltSurface s({}), plain({});
  ASSERT_TRUE(s.moveTo(window, mediaTime(t - 0.001)));
  s.prepare(window, mediaTime(t), 0, 0);
  ASSERT_TRUE(s.moveTo(window, mediaTime(t)));
  ASSERT_TRUE(plain.moveTo(window, mediaTime(t)));
  for (const double x : {-1.0, 0.0, 0.5, 1.0, 2.0}) EXPECT_NEAR(s.height(x, 0), plain.height(x, 0), 1e-3) << x;
}

// Pixel 180 of 360 reaches from 0 to 0.444 mm.
TEST(FeltSurface, TheLowestSampleIsTheNearestOneOfThePresentFrameAndTheNext) {
  const auto lowest = [](auto&& now, auto&& next, double x, std::uint32_t next_shot = 0) {
    std::vector<Frame> frames;
    frames.push_back(makeGrayFrame(kCols, kRows, 8, mediaTime(0), [&](int c, int) { return now(c); }));
    frames.push_back(makeGrayFrame(kCols, kRows, 8, mediaTime(kPeriod), [&](int c, int) { return next(c); }));
    SurfaceWindow w = makeWindow(frames, kVolume, {.bits = 8, .invalid = 0});
    w.frames[1].shot = next_shot;
    FeltSurface s({});
    EXPECT_TRUE(s.moveTo(w, mediaTime(0.01)));
    return s.lowestSample(x, 0);
  };
  const auto flat = [](int code) { return [code](int) { return code; }; };
  const auto step = [](int c) { return c < 180 ? 51 : 102; };
  EXPECT_NEAR(lowest(flat(102), flat(51), 1), 8, 1e-9);
  EXPECT_NEAR(lowest(flat(51), flat(102), 1), 8, 1e-9);
  EXPECT_NEAR(lowest(flat(102), flat(51), 1, 1), 16, 1e-9) << "the next one is another scene";
  EXPECT_EQ(lowest(flat(102), flat(0), 1), -40) << "a hole";
  EXPECT_EQ(lowest(flat(0), flat(102), 1), -40);
  EXPECT_EQ(lowest(flat(102), flat(102), 81), -40) << "outside";
  EXPECT_NEAR(lowest(step, step, -0.01), 8, 1e-9);
  EXPECT_NEAR(lowest(step, step, 0.01), 16, 1e-9);
}

}  // namespace
}  // namespace relievo
