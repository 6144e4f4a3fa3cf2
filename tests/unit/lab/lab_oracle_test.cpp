// SPDX-License-Identifier: Apache-2.0
// The laboratory's truth against closed forms and against brute force.
#include "app/lab/truth/oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "tests/unit/lab/oracle_paths.h"

namespace relievo::test {
namespace {

// The nearest place within 15 mm of the finger's own, by heights on ever finer grids.
glm::dvec3 bruteForceNearest(const TrueSurface& s, const glm::dvec3& hip, double t) {
  glm::dvec3 best = hip;
  glm::dvec2 middle(hip);
  double least = std::numeric_limits<double>::infinity();
  double half = 15;
  for (int level = 0; level < 9; ++level, half *= 0.1) {
    constexpr int kSteps = 60;
    for (int i = -kSteps; i <= kSteps; ++i) {
      for (int k = -kSteps; k <= kSteps; ++k) {
        const double x = middle.x + half * i / kSteps, y = middle.y + half * k / kSteps;
        const glm::dvec3 place(x, y, s.height(x, y, t));
        if (const double distance = glm::distance(place, hip); distance < least) {
          least = distance;
          best = place;
        }
      }
    }
    middle = glm::dvec2(best);
  }
  return best;
}

TEST(Oracle, OnAPlaneIsTheFootOfThePerpendicular) {
  for (const char* name : {"plane", "plane-sliding", "plane-heaving", "shallow-plane"}) {
    const auto s = makeTrueSurface(name);
    int contacts = 0;
    for (const auto& [t, hip, touch] : follow(*s, wandering(*s, 5), 2)) {
      const glm::dvec3 normal = unitNormal(*s, 0, 0, t);
      const glm::dvec3 foot = hip + normal * (normal.z * (s->height(hip.x, hip.y, t) - hip.z));
      EXPECT_EQ(touch.contact, glm::dot(foot - hip, normal) > 0) << name << " " << t;
      if (!touch.contact) continue;
      ++contacts;
      ASSERT_LT(glm::distance(touch.proxy_mm, foot), 1e-9) << name << " " << t;
    }
    EXPECT_GT(contacts, 1900) << name;
  }
}

TEST(Oracle, OnASphereLiesOnTheRayFromItsCentre) {
  for (const char* name : {"sphere", "sphere-sliding", "sphere-heaving"}) {
    const auto s = makeTrueSurface(name);
    int contacts = 0;
    for (const auto& [t, hip, touch] : follow(*s, wandering(*s, 5, 14), 2)) {
      if (!touch.contact) continue;
      ++contacts;
      const double turn = 2 * std::numbers::pi * t;
      glm::dvec3 centre(0, 0, -4);
      if (s->jet(5, 0, 0).zt != 0) {  // it moves
        const bool slides = std::string_view(name).ends_with("sliding");
        (slides ? centre.x : centre.z) += slides ? 4 * std::sin(0.53 * turn) : 2 * std::sin(0.67 * turn);
      }
      ASSERT_LT(glm::distance(touch.proxy_mm, centre + 40.0 * glm::normalize(hip - centre)), 1e-9) << name << " " << t;
    }
    EXPECT_GT(contacts, 1900) << name;
  }
}

TEST(Oracle, OnTheFacePointsAlongTheNormalFromAnyDepth) {
  const auto s = makeTrueSurface("face-nodding");
  for (const double depth : {0.5, 2.0, 5.0}) {
    int contacts = 0;
    for (const auto& [t, hip, touch] : follow(*s, wandering(*s, depth), 2)) {
      if (!touch.contact) continue;
      ++contacts;
      const glm::dvec3& p = touch.proxy_mm;
      ASSERT_NEAR(p.z, s->height(p.x, p.y, t), 1e-12);
      ASSERT_LT(glm::length(glm::cross(p - hip, unitNormal(*s, p.x, p.y, t))), 1e-11) << depth << " " << t;
      ASSERT_NEAR(glm::distance(p, hip), depth, depth * (t < 0.1 ? 1.0 : 1e-9)) << t;
    }
    EXPECT_GT(contacts, 1900);
  }
}

TEST(Oracle, OnTheFaceIsWhatBruteForceFinds) {
  const auto s = makeTrueSurface("face-nodding");
  // The finger's depth is given by the height of another place of the face, so that the path does not use the oracle's
  // normals.
  const Path path = [&](double t) {
    const double x = 26 * std::sin(4.3 * t), y = 24 * std::sin(2.9 * t + 1);
    return glm::dvec3(x, y, s->height(x + 3, y - 2, t) + 10 - std::min(t / 0.1, 1.0) * 13);
  };
  int compared = 0;
  const auto moments = follow(*s, path, 3);
  for (std::size_t i = 0; i < moments.size(); i += 37) {
    const auto& [t, hip, touch] = moments[i];
    if (!touch.contact || s->height(hip.x, hip.y, t) - hip.z > 6) continue;
    ++compared;
    const glm::dvec3 brute = bruteForceNearest(*s, hip, t);
    EXPECT_NEAR(glm::distance(touch.proxy_mm, hip), glm::distance(brute, hip), 1e-9) << t;
    EXPECT_LT(glm::distance(touch.proxy_mm, brute), 1e-4) << t;
  }
  EXPECT_GT(compared, 20);
}

TEST(Oracle, DoesNotDependOnTheTick) {
  const auto s = makeTrueSurface("face-nodding");
  const auto coarse = follow(*s, wandering(*s, 3), 1, 0.001), fine = follow(*s, wandering(*s, 3), 1, 0.00025);
  ASSERT_GE(coarse.size(), 1000u);
  ASSERT_GT(fine.size(), 4 * (coarse.size() - 1));
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    ASSERT_EQ(coarse[i].touch.contact, fine[4 * i].touch.contact);
    ASSERT_LT(glm::distance(coarse[i].touch.proxy_mm, fine[4 * i].touch.proxy_mm), 1e-11) << i;
  }
}

TEST(Oracle, KeepsAFingerThatARisingPlaneHasReached) {
  for (const double speed : {5.0, 80.0, 1000.0}) {
    const auto s = makeTrueSurface("rise", {.speed_mm_per_s = speed});
    const glm::dvec3 hip(3, -2, 15);
    int contacts = 0;
    for (const auto& [t, at, touch] : follow(*s, [&](double) { return hip; }, s->traits().duration_s)) {
      const bool reached = s->height(hip.x, hip.y, t) > hip.z;
      ASSERT_EQ(touch.contact, reached) << speed << " " << t;
      if (!reached) continue;
      ++contacts;
      const glm::dvec3 normal = unitNormal(*s, 0, 0, t);
      ASSERT_LT(glm::length(glm::cross(touch.proxy_mm - hip, normal)), 1e-9);
    }
    EXPECT_GT(contacts, 10) << speed;
  }
}

TEST(Oracle, LetsGoOutsideAndComesBackIntoContact) {
  const auto s = makeTrueSurface("face-nodding");
  const Path path = [&](double t) {
    const double x = 9 * t, y = 5 - 7 * t;
    return glm::dvec3(x, y, s->height(x, y, t) + 1.7 * std::cos(40 * t));
  };
  int changes = 0;
  bool before = false;
  for (const auto& [t, hip, touch] : follow(*s, path, 1)) {
    ASSERT_EQ(touch.contact, hip.z < s->height(hip.x, hip.y, t)) << t;
    if (!touch.contact) {
      ASSERT_EQ(touch.proxy_mm, hip);
    }
    changes += touch.contact != before ? 1 : 0;
    before = touch.contact;
  }
  EXPECT_EQ(changes, 13);  // cos(40 t) changes its sign 13 times in a second
}

TEST(Oracle, LeavesAFingerFreeThatBeginsInsideUntilItHasComeOut) {
  const auto s = makeTrueSurface("sphere");
  Oracle oracle(*s);
  EXPECT_FALSE(oracle.update({0, 0, 30}, 0).contact);
  EXPECT_FALSE(oracle.update({2, 0, 20}, 0.001).contact);
  EXPECT_FALSE(oracle.update({2, 0, 38}, 0.002).contact);
  EXPECT_TRUE(oracle.update({2, 0, 33}, 0.003).contact);
  oracle.reset();
  EXPECT_FALSE(oracle.update({2, 0, 33}, 0.004).contact);
}

TEST(Oracle, BeginsANewAtACut) {
  const auto up = makeTrueSurface("cut-up", {.cut_s = 0.01}), down = makeTrueSurface("cut-down", {.cut_s = 0.01});
  for (const auto* s : {up.get(), down.get()}) {
    Oracle oracle(*s);
    const double floor = s->height(0, 0, 0), next = s->height(0, 0, 0.02);
    EXPECT_FALSE(oracle.update({0, 0, floor + 1}, 0).contact);
    EXPECT_TRUE(oracle.update({0, 0, floor - 1}, 0.009).contact);
    EXPECT_FALSE(oracle.update({0, 0, floor - 1}, 0.011).contact);
    EXPECT_FALSE(oracle.update({0, 0, next + 1}, 0.02).contact);
    EXPECT_TRUE(oracle.update({0, 0, next - 1}, 0.03).contact);
  }
}

// Coordinates across the ridge: q from its middle line.
glm::dvec3 acrossRidge(double q, double z) {
  return {0.96 * q, -0.28 * q, z};
}

TEST(Oracle, StaysOnTheSideOfARidgeWhereAFastFingerCameIn) {
  const auto s = makeTrueSurface("ridge");
  for (const double side : {-1.0, 1.0}) {
    Oracle oracle(*s);
    EXPECT_FALSE(oracle.update(acrossRidge(side * 4.6, 20.6), 0).contact);
    const glm::dvec3 hip = acrossRidge(side * -0.3, 20.6);  // 4.9 m/s, through the ridge's middle
    const TrueTouch touch = oracle.update(hip, 0.001);
    ASSERT_TRUE(touch.contact);
    EXPECT_GT(side * (0.96 * touch.proxy_mm.x - 0.28 * touch.proxy_mm.y), 0.5);
    const glm::dvec3 normal = unitNormal(*s, touch.proxy_mm.x, touch.proxy_mm.y, 0);
    EXPECT_LT(glm::length(glm::cross(touch.proxy_mm - hip, normal)), 1e-11);
    EXPECT_LT(glm::distance(bruteForceNearest(*s, hip, 0), hip), glm::distance(touch.proxy_mm, hip) - 0.1);
    // Out on the far side within one tick: free, no matter what lay between.
    EXPECT_FALSE(oracle.update(acrossRidge(side * -5, 20.6), 0.002).contact);
  }
}

TEST(Oracle, KnowsTheLastOfSeveralCrossingsWithinATick) {
  const auto s = makeTrueSurface("ridge");
  Oracle oracle(*s);
  EXPECT_FALSE(oracle.update(acrossRidge(-5, 24.4), 0).contact);
  // In and out through the ridge, then into the floor behind it.
  const TrueTouch touch = oracle.update(acrossRidge(5, 19.6), 0.001);
  ASSERT_TRUE(touch.contact);
  EXPECT_LT(glm::distance(touch.proxy_mm, acrossRidge(5, 20)), 1e-11);
}

TEST(Oracle, DoesNotBalanceOnACrest) {
  const auto s = makeTrueSurface("ridge");
  Oracle oracle(*s);
  EXPECT_FALSE(oracle.update({0, 0, 25}, 0).contact);
  const glm::dvec3 hip(0, 0, 21);  // 3 mm below a crest with a radius of 0.45 mm: the crest is a maximum of distance
  const TrueTouch touch = oracle.update(hip, 0.01);
  ASSERT_TRUE(touch.contact);
  EXPECT_LT(glm::distance(touch.proxy_mm, hip), 2.0);
  EXPECT_NEAR(glm::distance(touch.proxy_mm, hip), glm::distance(bruteForceNearest(*s, hip, 0), hip), 1e-9);
}

}  // namespace
}  // namespace relievo::test
