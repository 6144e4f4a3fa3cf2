// SPDX-License-Identifier: Apache-2.0
// The true surfaces: derivatives against differences, heights inside the volume, the figures that their names promise.
#include "app/lab/truth/true_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace relievo {
namespace {

constexpr double kHalfWidth = TrueSurface::kVolume.width_mm / 2, kHalfHeight = TrueSurface::kVolume.height_mm / 2;

StepWall wallOf(const TrueSurface& s, double t) {
  return s.wallAt(t).value_or(StepWall{});
}

struct Place {
  double x, y, t;
};

std::vector<Place> randomPlaces(const TrueSurface& surface, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const double end = std::min(surface.traits().duration_s, 4.0);
  std::vector<Place> places;
  places.reserve(count);
  for (int i = 0; i < count; ++i) {
    places.push_back({(2 * unit(random) - 1) * kHalfWidth, (2 * unit(random) - 1) * kHalfHeight, unit(random) * end});
  }
  return places;
}

// Largest convex principal curvature, 1/mm: the surface's normal curvature where it bulges toward the viewer.
double convexCurvature(const SurfaceJet& s) {
  const double w2 = 1 + s.zx * s.zx + s.zy * s.zy, w = std::sqrt(w2);
  const double mean = ((1 + s.zy * s.zy) * s.zxx - 2 * s.zx * s.zy * s.zxy + (1 + s.zx * s.zx) * s.zyy) / (2 * w2 * w);
  const double gauss = (s.zxx * s.zyy - s.zxy * s.zxy) / (w2 * w2);
  return -mean + std::sqrt(std::max(0.0, mean * mean - gauss));
}

class EveryTrueSurface : public testing::TestWithParam<std::string_view> {};
INSTANTIATE_TEST_SUITE_P(Scenes, EveryTrueSurface,
                         testing::ValuesIn(trueSurfaceNames().begin(), trueSurfaceNames().end()),
                         [](const auto& scene) {
                           std::string name(scene.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(EveryTrueSurface, StaysInTheVolume) {
  const auto s = makeTrueSurface(GetParam());
  for (const auto& [x, y, t] : randomPlaces(*s, 20000)) {
    const double z = s->height(x, y, t);
    ASSERT_GE(z, 0) << x << " " << y << " " << t;
    ASSERT_LE(z, TrueSurface::kVolume.depth_mm) << x << " " << y << " " << t;
  }
}

TEST_P(EveryTrueSurface, GivesARowOfHeightsAsItGivesOne) {
  const auto s = makeTrueSurface(GetParam());
  const std::vector<double> xs{-71, -20.5, -3, 0, 3.5, 17, 60};
  std::vector<double> row(xs.size());
  for (const double t : {0.0, 0.3, 0.9}) {
    s->heights(xs, -6.25, t, row);
    for (std::size_t i = 0; i < xs.size(); ++i) {
      EXPECT_DOUBLE_EQ(row[i], s->height(xs[i], -6.25, t));
      EXPECT_DOUBLE_EQ(row[i], s->jet(xs[i], -6.25, t).z);
    }
  }
}

TEST_P(EveryTrueSurface, HasTheDerivativesOfItsHeights) {
  const auto s = makeTrueSurface(GetParam());
  if (s->wallAt(0) || s->shotAt(0) != s->shotAt(4)) return;  // not differentiable by its nature
  const double h = 1e-5;
  for (const auto& [x, y, t] : randomPlaces(*s, 2000)) {
    const auto by = [&](double dx, double dy, double dt) {
      return (s->height(x + h * dx, y + h * dy, t + h * dt) - s->height(x - h * dx, y - h * dy, t - h * dt)) / (2 * h);
    };
    const SurfaceJet j = s->jet(x, y, t), right = s->jet(x + h, y, t), left = s->jet(x - h, y, t),
                     up = s->jet(x, y + h, t), down = s->jet(x, y - h, t);
    ASSERT_NEAR(j.zx, by(1, 0, 0), 1e-7);
    ASSERT_NEAR(j.zy, by(0, 1, 0), 1e-7);
    ASSERT_NEAR(j.zt, by(0, 0, 1), 1e-6);
    // The third derivative jumps at the rims of the folds and of the head, so that a difference there is good to h.
    ASSERT_NEAR(j.zxx, (right.zx - left.zx) / (2 * h), 3e-5);
    ASSERT_NEAR(j.zxy, (right.zy - left.zy) / (2 * h), 3e-5);
    ASSERT_NEAR(j.zyy, (up.zy - down.zy) / (2 * h), 3e-5);
  }
}

TEST_P(EveryTrueSurface, IsNoFasterThanItSaysAndNearlyAsFast) {
  const auto s = makeTrueSurface(GetParam());
  if (s->wallAt(0)) {
    const double moved = wallOf(*s, 0.1).offset_mm - wallOf(*s, 0).offset_mm;
    EXPECT_NEAR(s->traits().max_speed_mm_per_s, std::abs(moved) / 0.1, 1e-9);
    return;
  }
  double fastest = 0;
  for (const auto& [x, y, t] : randomPlaces(*s, 50000)) fastest = std::max(fastest, std::abs(s->jet(x, y, t).zt));
  EXPECT_LE(fastest, s->traits().max_speed_mm_per_s * 1.002);
  EXPECT_GE(fastest, s->traits().max_speed_mm_per_s * 0.85);
}

TEST_P(EveryTrueSurface, HasNoConvexPlaceTighterThanSixMillimetresWhereItCountsForAccuracy) {
  const auto s = makeTrueSurface(GetParam());
  if (!s->traits().smooth) return;
  for (const auto& [x, y, t] : randomPlaces(*s, 50000)) {
    ASSERT_LT(convexCurvature(s->jet(x, y, t)), 1 / 6.0) << x << " " << y << " " << t;
  }
}

TEST(TrueSurface, KnowsNoOtherNames) {
  EXPECT_EQ(makeTrueSurface("potato"), nullptr);
  EXPECT_GE(trueSurfaceNames().size(), 19u);
}

TEST(TrueSurface, ShallowPlaneAndNoseHaveTheSlopeAndTheRadiusThatTheyAreNamedFor) {
  const SurfaceJet plane = makeTrueSurface("shallow-plane")->jet(3, 4, 0);
  EXPECT_NEAR(std::hypot(plane.zx, plane.zy), 0.033, 1e-5);
  const auto face = makeTrueSurface("face");
  double tightest = 0, highest = 0, lowest = 40;
  for (int r = -200; r <= 200; ++r) {
    for (int c = -200; c <= 200; ++c) {
      const SurfaceJet j = face->jet(0.25 * c, 0.25 * r, 0);
      tightest = std::max(tightest, convexCurvature(j));
      highest = std::max(highest, j.z);
      lowest = std::min(lowest, j.z);
    }
  }
  EXPECT_NEAR(1 / tightest, 7, 0.3);
  EXPECT_NEAR(highest - lowest, 33, 0.5);
}

TEST(TrueSurface, SphereIsOneWithinItsExactPart) {
  const auto s = makeTrueSurface("sphere");
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {10.0, -8.0}, {-19.7, 19.7}}) {
    EXPECT_NEAR(std::hypot(x, y, s->height(x, y, 0) + 4), 40, 1e-12);
  }
}

TEST(TrueSurface, RisesAndSweepsAtTheSpeedThatIsAskedFor) {
  for (const double speed : {5.0, -300.0}) {
    const auto rise = makeTrueSurface("rise", {.speed_mm_per_s = speed});
    EXPECT_NEAR(rise->height(1, 2, 0.05) - rise->height(1, 2, 0), 0.05 * speed, 1e-12);
    // A wall that moves by v along x keeps its place in a frame that moves along.
    const auto step = makeTrueSurface("step-moving", {.speed_mm_per_s = speed});
    EXPECT_NEAR(wallOf(*step, 0.05).distance(0.05 * speed, 7), wallOf(*step, 0).distance(0, 7), 1e-12);
  }
}

TEST(TrueSurface, StepFallsByFifteenMillimetresAtItsSlantedEdge) {
  const auto s = makeTrueSurface("step");
  for (const double y : {-30.0, 0.0, 12.0}) {
    const double edge = 3.17 + 0.3 * y;
    EXPECT_EQ(s->height(edge - 1e-9, y, 0), 27.5);
    EXPECT_EQ(s->height(edge + 1e-9, y, 0), 12.5);
  }
  EXPECT_FALSE(s->traits().smooth);
}

TEST(TrueSurface, CutsAtOneMoment) {
  const auto up = makeTrueSurface("cut-up", {.cut_s = 0.25});
  EXPECT_NEAR(up->height(0, 0, 0.25) - up->height(0, 0, 0.2499999), 18, 1e-9);
  EXPECT_NE(up->shotAt(0.25), up->shotAt(0.2499999));
  const auto down = makeTrueSurface("cut-down", {.cut_s = 0.25});
  EXPECT_NEAR(down->height(0, 0, 0.25) - down->height(0, 0, 0.2499999), -9, 1e-9);
}

}  // namespace
}  // namespace relievo
