// SPDX-License-Identifier: Apache-2.0
// Paths of a finger: their way in, their depth, their speed, and that the oracle follows them.
#include "app/lab/finger/finger_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/lab/truth/oracle.h"

namespace relievo {
namespace {

constexpr std::size_t kIn = 200;  // the tick at which the finger has come in

TEST(FingerPath, HasAnEntryEachMillisecond) {
  const auto s = makeTrueSurface("plane");
  const auto path = makeFingerPath(*s, {.duration_s = 0.75});
  ASSERT_EQ(path.size(), 750u);
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_DOUBLE_EQ(path[i].t_s, static_cast<double>(i) / 1000);
}

TEST(FingerPath, ComesInStraightAlongTheNormalFromTenMillimetresAbove) {
  const auto s = makeTrueSurface("sphere");
  const auto path = makeFingerPath(*s, {.depth_mm = 5, .speed_mm_per_s = 1000});
  const glm::dvec3 centre(0, 0, -4);
  const glm::dvec3 normal = glm::normalize(path[0].hip_mm - centre);
  for (std::size_t i = 0; i <= kIn; ++i) {
    const double radius = 50 - 15 * static_cast<double>(i) / kIn;
    EXPECT_LT(glm::distance(path[i].hip_mm, centre + radius * normal), 1e-9) << i;
  }
}

TEST(FingerPath, KeepsItsDepthUnderAMovingSurface) {
  for (const double depth : {1.0, 5.0}) {
    for (const double speed : {0.0, 100.0, 1000.0, 5000.0}) {
      const auto s = makeTrueSurface("sphere-sliding");
      const auto path = makeFingerPath(*s, {.depth_mm = depth, .speed_mm_per_s = speed, .duration_s = 2});
      for (std::size_t i = kIn; i < path.size(); ++i) {
        const glm::dvec3 centre(4 * std::sin(2 * std::numbers::pi * 0.53 * path[i].t_s), 0, -4);
        ASSERT_NEAR(glm::distance(path[i].hip_mm, centre), 40 - depth, 1e-9) << speed << " " << i;
      }
    }
  }
}

TEST(FingerPath, GoesAtConstantSpeedOverTheWholeMiddle) {
  const auto s = makeTrueSurface("plane");
  const glm::dvec3 aside = 5.0 * glm::normalize(glm::dvec3(-0.15, -0.08, 1));  // the same everywhere on a plane
  for (const double speed : {100.0, 1000.0, 5000.0}) {
    const auto path =
        makeFingerPath(*s, {.speed_mm_per_s = speed, .duration_s = 6, .centre_mm = {2, 1}, .reach_mm = {18, 15}});
    glm::dvec2 least(1e9), most(-1e9);
    double slowest = 1e9, fastest = 0;
    for (std::size_t i = kIn + 1; i < path.size(); ++i) {
      const glm::dvec2 plan(path[i].hip_mm + aside);
      least = glm::min(least, plan);
      most = glm::max(most, plan);
      const double way = glm::distance(plan, glm::dvec2(path[i - 1].hip_mm + aside));
      slowest = std::min(slowest, way * 1000);
      fastest = std::max(fastest, way * 1000);
    }
    EXPECT_LE(fastest, speed * 1.0001);
    if (speed < 200) {
      EXPECT_GE(slowest, speed * 0.999);  // a chord is a little shorter than its arc
    }
    EXPECT_NEAR(least.x, 2 - 18, 0.2);
    EXPECT_NEAR(least.y, 1 - 15, 0.2);
    EXPECT_NEAR(most.x, 2 + 18, 0.2);
    EXPECT_NEAR(most.y, 1 + 15, 0.2);
  }
}

TEST(FingerPath, HeldFingerStaysAtItsPlaceOnTheSurface) {
  const auto s = makeTrueSurface("plane-heaving");
  const auto path = makeFingerPath(*s, {.speed_mm_per_s = 0, .duration_s = 1});
  ASSERT_GT(path.size(), kIn + 100);
  const glm::dvec3 first = path[kIn].hip_mm - glm::dvec3(0, 0, s->height(0, 0, path[kIn].t_s));
  for (std::size_t i = kIn; i < path.size(); ++i) {
    const glm::dvec3 now = path[i].hip_mm - glm::dvec3(0, 0, s->height(0, 0, path[i].t_s));
    ASSERT_LT(glm::distance(now, first), 1e-12);
  }
}

TEST(FingerPath, OracleHoldsTheProxyAtTheDepthOfThePathOnEverySmoothSurface) {
  int surfaces = 0;
  for (const std::string_view name : trueSurfaceNames()) {
    const auto s = makeTrueSurface(name);
    if (!s->traits().smooth) continue;
    ++surfaces;
    for (const double speed : {100.0, 1000.0, 5000.0}) {
      Oracle oracle(*s);
      std::size_t tick = 0;
      const double duration = std::min(1.2, s->traits().duration_s);
      for (const auto& [t, hip] : makeFingerPath(*s, {.speed_mm_per_s = speed, .duration_s = duration})) {
        const TrueTouch touch = oracle.update(hip, t);
        if (tick++ < kIn) continue;
        ASSERT_TRUE(touch.contact) << name << " " << t;
        ASSERT_NEAR(glm::distance(touch.proxy_mm, hip), 5, 1e-9) << name << " " << speed << " " << t;
      }
    }
  }
  EXPECT_EQ(surfaces, 12);
}

}  // namespace
}  // namespace relievo
