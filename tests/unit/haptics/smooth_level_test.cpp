// SPDX-License-Identifier: Apache-2.0
// The felt surface away from edges: broad where it is even, wide where it is not, narrower at
// creases, and smooth in between.
#include "app/haptics/method/smooth_level.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/haptics/method/felt_surface.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kPeriod = 1.0 / 30, kStepMm = 40.0 / 255;
constexpr std::uint64_t kOfFourPoints = 24, kOfTheirBends = 32;  // blocks of their fourth and second differences
constexpr FeltScale kWide{.wide_mm = 2};
constexpr FeltScale kBroad{.wide_mm = 2, .broad_mm = 4, .broad_even_mm = kStepMm / 2};

template <class Height>
std::vector<Frame> film(Height&& height) {
  return test::makeReliefFilm(6, kPeriod, 720, 486, kVolume, height);
}

// A shallow plane to the left of a ball of 15 mm, in 8 bits.
double plane(double x, double y) {
  return 12 + 0.033 * x + 0.01 * y;
}
double planeAndBall(double x, double y, double) {
  const double r2 = (x - 40) * (x - 40) + y * y;
  return kStepMm * std::round(1 / kStepMm * std::max(plane(x, y), r2 < 15 * 15 ? std::sqrt(15 * 15 - r2) + 6 : 0.0));
}

// Where the surface becomes even, the broad level is read in so many ticks: a frame in each.
void prepareAll(FeltSurface& surface, const SurfaceWindow& window, double t, double x, double y) {
  for (int tick = 0; tick < 7; ++tick) surface.prepare(window, mediaTime(t), x, y);
}

double worstSlope(FeltSurface& surface, double from_x, double to_x) {
  double worst = 0;
  for (double x = from_x; x <= to_x; x += 0.7) {
    for (double y = -20; y <= 20; y += 3.1) {
      const SurfacePoint p = surface.at(x, y);
      worst = std::max(worst, std::hypot(p.zx - 0.033, p.zy - 0.01));
    }
  }
  return worst;
}

TEST(SmoothLevel, AShallowPlaneHasLessOfItsStepsAndABallIsAsBefore) {
  const auto frames = film(planeAndBall);
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface wide(kWide), broad(kBroad);
  ASSERT_TRUE(wide.moveTo(window, mediaTime(0.07)) && broad.moveTo(window, mediaTime(0.07)));
  const double of_wide = worstSlope(wide, -60, -25), of_broad = worstSlope(broad, -60, -25);
  EXPECT_GT(of_wide, 0.004);
  EXPECT_LT(of_broad, 0.5 * of_wide);
  for (double x = 30; x <= 50; x += 0.9) EXPECT_EQ(broad.height(x, 3), wide.height(x, 3)) << x;
}

TEST(SmoothLevel, TheBroadLevelAloneIsReadWhereItCounts) {
  const auto frames = film([](double x, double y, double) { return x < 0 ? 12 : planeAndBall(x, y, 0); });
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  const auto blocksAt = [&](const FeltScale& scale, double x) {
    FeltSurface surface(scale);
    EXPECT_TRUE(surface.moveTo(window, mediaTime(0.07)));
    const auto before = surface.blocksRead();
    (void)surface.at(x, 0);
    return surface.blocksRead() - before;
  };
  EXPECT_EQ(blocksAt(kBroad, -45), blocksAt(kWide, -45) + kOfTheirBends)
      << "as many, twice as large, and the next frame";
  EXPECT_GT(blocksAt(kBroad, 40), blocksAt(kWide, 40));
}

TEST(SmoothLevel, WhereItIsNotEvenTheBroadLevelIsReadInTwoFrames) {
  const auto frames = film(planeAndBall);
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface wide(kWide), broad(kBroad);
  ASSERT_TRUE(wide.moveTo(window, mediaTime(0.07)) && broad.moveTo(window, mediaTime(0.07)));
  prepareAll(wide, window, 0.071, 40, 0);
  prepareAll(broad, window, 0.071, 40, 0);
  EXPECT_EQ(broad.blocksRead() - wide.blocksRead(), 2 * kOfTheirBends);
  const double of_ball = broad.height(40, 0);
  EXPECT_EQ(of_ball, wide.height(40, 0));
  prepareAll(broad, window, 0.071, -45, 0);
  FeltSurface plain(kBroad);
  ASSERT_TRUE(plain.moveTo(window, mediaTime(0.071)) && broad.moveTo(window, mediaTime(0.071)));
  EXPECT_EQ(broad.height(-45, 0), plain.height(-45, 0)) << "the others follow where it is even";
}

TEST(SmoothLevel, WhatWasUnevenBecomesEvenWithTheFilm) {
  const auto frames =
      film([](double x, double y, double t) { return t > 2.5 * kPeriod ? plane(x, y) : planeAndBall(x, y, t); });
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface wide(kWide), broad(kBroad);
  bool uneven = false, even = false;
  for (double t = 0.02; t < 5 * kPeriod; t += 0.001) {
    ASSERT_TRUE(wide.moveTo(window, mediaTime(t)) && broad.moveTo(window, mediaTime(t)));
    const double of_wide = wide.height(40, 0), of_broad = broad.height(40, 0);
    uneven |= of_broad == of_wide;
    even = of_broad != of_wide;
    broad.prepare(window, mediaTime(t + 0.001), 40, 0);
  }
  EXPECT_TRUE(uneven && even);
}

// Beside a hole, further away than the wide level's control points reach and nearer than the broad level's do. A block
// that the hole only cuts has the mean height of its other samples.
TEST(SmoothLevel, WhatLiesBeyondAPointThatIsNotEvenIsNotFelt) {
  const auto frames = film([](double x, double, double) { return x > 0 ? 0.0 : 12.0; });
  const SurfaceWindow window = test::makeWindow(frames, kVolume, {.bits = 16, .invalid = 0});
  FeltSurface broad(kBroad);
  ASSERT_TRUE(broad.moveTo(window, mediaTime(0.07)));
  ASSERT_LT(broad.height(3, 1), 0);
  for (double x = -40; x < -5; x += 0.1) {
    ASSERT_NEAR(broad.height(x, 1), 12, 0.002) << x;
    ASSERT_NEAR(broad.at(x, 1).zx, 0, 0.002) << x;
  }
}

// Along a line. Returns at how many of its places the height is that of neither level alone.
int expectDerivatives(FeltSurface& surface, FeltSurface& wide, FeltSurface& narrow, double from_x, double to_x) {
  constexpr double kStep = 0.02;
  int mixed = 0;
  for (double x = from_x; x < to_x; x += 0.037) {
    const SurfacePoint p = surface.at(x, 2), e = surface.at(x + kStep, 2), o = surface.at(x - kStep, 2),
                       n = surface.at(x, 2 + kStep), s = surface.at(x, 2 - kStep);
    EXPECT_NEAR(p.zx, (e.z - o.z) / (2 * kStep), 5e-4) << x;
    EXPECT_NEAR(p.zy, (n.z - s.z) / (2 * kStep), 5e-4) << x;
    EXPECT_NEAR(p.zxx, (e.zx - o.zx) / (2 * kStep), 2e-3) << x;
    EXPECT_NEAR(p.zxy, (n.zx - s.zx) / (2 * kStep), 2e-3) << x;
    EXPECT_NEAR(p.zyy, (n.zy - s.zy) / (2 * kStep), 2e-3) << x;
    EXPECT_NEAR(p.z, surface.height(x, 2), 1e-5) << x;
    mixed += std::min(std::abs(p.z - wide.height(x, 2)), std::abs(p.z - narrow.height(x, 2))) > 1e-6 ? 1 : 0;
  }
  return mixed;
}

TEST(SmoothLevel, ItsDerivativesAreThoseOfItsHeightWhereBothLevelsCount) {
  const auto frames = film(planeAndBall);
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltScale always = kBroad;
  always.broad_even_mm = 1e6;
  FeltSurface surface(kBroad), broad(always), wide(kWide);
  for (FeltSurface* each : {&surface, &broad, &wide}) ASSERT_TRUE(each->moveTo(window, mediaTime(0.07)));
  EXPECT_GT(expectDerivatives(surface, broad, wide, -20, 20), 20);
}

TEST(SmoothLevel, WhatWasPreparedIsWhatWouldHaveBeenComputed) {
  const auto frames = film(planeAndBall);
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface ahead(kBroad), plain(kBroad);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-30, 10), y(-10, 10), jitter(-0.0002, 0.0002);
  double t = 0.07;
  for (int i = 0; i < 60; ++i) {
    const double px = x(random), py = y(random), next = t + 0.001;
    ASSERT_TRUE(ahead.moveTo(window, mediaTime(t)));
    prepareAll(ahead, window, next, px, py);
    t = next + jitter(random);
    ASSERT_TRUE(ahead.moveTo(window, mediaTime(t)) && plain.moveTo(window, mediaTime(t)));
    ASSERT_NEAR(ahead.at(px, py).z, plain.at(px, py).z, 1e-4) << i;
    ASSERT_NEAR(ahead.at(px, py).zx, plain.at(px, py).zx, 1e-3) << i;
  }
}

// A valley, whose bottom every smoothing lifts by a share of its width.
constexpr FeltScale kMiddle{.wide_mm = 2, .middle_mm = 1, .wide_even_mm = 0.1};
constexpr FeltScale kMiddleAlone{.wide_mm = 1, .wide_time = TimeLaw::Linear};
constexpr double kBottom = -10 * 160.0 / 720;  // between two of the wide level's blocks, which are 14 samples wide
double valley(double x, double, double) {
  return 12 + 0.2 * std::abs(x - kBottom);
}

TEST(SmoothLevel, ACreaseIsRoundedByTheMiddleLevel) {
  const auto frames = film(valley);
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface wide(kWide), middle(kMiddle);
  ASSERT_TRUE(wide.moveTo(window, mediaTime(0.07)) && middle.moveTo(window, mediaTime(0.07)));
  double lifted_by_wide = 0, lifted_by_middle = 0;
  for (double y = -20; y <= 20; y += 0.7) {
    lifted_by_wide = std::max(lifted_by_wide, wide.height(kBottom, y) - 12);
    lifted_by_middle = std::max(lifted_by_middle, middle.height(kBottom, y) - 12);
  }
  EXPECT_LT(lifted_by_middle, 0.6 * lifted_by_wide);
  for (double x = 15; x <= 30; x += 0.9) EXPECT_EQ(middle.height(x, 3), wide.height(x, 3)) << x;
}

TEST(SmoothLevel, AtACreaseTheWideLevelIsReadInTwoFrames) {
  const auto frames = film(valley);
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface middle(kMiddle), alone(kMiddleAlone);
  ASSERT_TRUE(middle.moveTo(window, mediaTime(0.07)) && alone.moveTo(window, mediaTime(0.07)));
  prepareAll(middle, window, 0.071, kBottom, 0);
  prepareAll(alone, window, 0.071, kBottom, 0);
  EXPECT_EQ(middle.blocksRead() - alone.blocksRead(), 2 * kOfFourPoints);
}

TEST(SmoothLevel, ItsDerivativesAreThoseOfItsHeightBesideACrease) {
  const auto frames = film([](double x, double y, double) { return 12 + 0.3 * std::abs(x + 0.3 * y); });
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface surface(kMiddle), wide(kWide), middle(kMiddleAlone);
  for (FeltSurface* each : {&surface, &wide, &middle}) ASSERT_TRUE(each->moveTo(window, mediaTime(0.07)));
  EXPECT_GT(expectDerivatives(surface, wide, middle, -15, 15), 20);
}

// Noise may make the range of what is even reach into that of edges: beyond 1 the blend would overshoot. The clamp is
// so wide that the smooth level alone is felt.
TEST(SmoothLevel, LiesBetweenItsLevelsHoweverMuchIsEven) {
  const auto unclamped = [](FeltScale scale) {
    scale.clamp_mm = 1e3;
    return scale;
  };
  FeltScale strong = unclamped(kMiddle);
  strong.wide_even_mm = 3.5;
  const auto frames = film([](double x, double, double) { return 20 + (3 + 0.06 * x) * std::sin(0.7 * x); });
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface surface(strong), wide(unclamped(kWide)), middle(unclamped(kMiddleAlone));
  for (FeltSurface* each : {&surface, &wide, &middle}) ASSERT_TRUE(each->moveTo(window, mediaTime(0.07)));
  int mixed = 0;
  for (double x = -45; x < 45; x += 0.13) {
    const double a = wide.height(x, 3), b = middle.height(x, 3), h = surface.height(x, 3);
    ASSERT_GE(h, std::min(a, b) - 1e-5) << x;
    ASSERT_LE(h, std::max(a, b) + 1e-5) << x;
    mixed += std::min(std::abs(h - a), std::abs(h - b)) > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(mixed, 20);
}

// The narrow level keeps an edge, wide or middle; a middle level there would be read for nothing.
TEST(SmoothLevel, AnEdgeIsNoCrease) {
  const auto frames = film([](double x, double, double) { return x < 0 ? 27.5 : 12.5; });
  const SurfaceWindow window = test::makeWindow(frames, kVolume);
  FeltSurface wide(kWide), middle(kMiddle);
  ASSERT_TRUE(wide.moveTo(window, mediaTime(0.07)) && middle.moveTo(window, mediaTime(0.07)));
  EXPECT_EQ(middle.height(0.1, 0), wide.height(0.1, 0));
  EXPECT_EQ(middle.blocksRead(), wide.blocksRead() + kOfFourPoints) << "of the next frame";
}

}  // namespace
}  // namespace relievo
