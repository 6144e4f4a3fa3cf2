// SPDX-License-Identifier: Apache-2.0
// The proxy graph and the paper's modified one: resting position of the proxy, and when contact is kept or lost.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

#include "app/haptics/baseline/graph_walk.h"
#include "app/haptics/baseline/methods.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using test::makeReliefFrame;
using test::makeWindow;

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr int kCols = 180, kRows = 122;  // cells of 0.889 mm by 0.885 mm
constexpr double kCellMm = 0.89;

std::unique_ptr<TouchMethod> method(std::string_view name, MethodConfig config = {}) {
  if (!config.jump_threshold) config.jump_threshold = false;
  return makeMethod(name, config);
}

// Two frames a second apart; between them a plane z = z0 + slope x rises by `rise` mm.
std::vector<Frame> planeFrames(double z0, double slope, double rise) {
  std::vector<Frame> frames;
  for (int k = 0; k < 2; ++k) {
    frames.push_back(makeReliefFrame(kCols, kRows, kVolume, mediaTime(k),
                                     [&](double x, double) { return z0 + slope * x + rise * k; }));
  }
  return frames;
}

TEST(GraphWalk, RestsNoFurtherThanHalfACellFromTheClosestPointOfAPlane) {
  const auto frames = planeFrames(20, 0.25, 0);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const SurfaceInTime s(w, {}, TimeLaw::Hold);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.25, 0, 1));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-60, 60), y(-45, 45), away(-8, 8);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 foot(x(random), y(random), 0);
    const glm::dvec3 closest(foot.x, foot.y, 20 + 0.25 * foot.x);
    const glm::dvec3 hip = closest - 3.0 * normal;
    // The walk begins up to 8 mm away, as after a fast move.
    const glm::dvec3 start(closest.x + away(random), closest.y + away(random), 0);
    const auto t = GridTriangle::under(s.grid().u(start.x), s.grid().v(start.y), kCols, kRows);
    ASSERT_TRUE(t.has_value());
    const glm::dvec3 proxy = walkToClosest(s, Crossing{start, *t}, hip);
    ASSERT_LE(glm::length(proxy - closest), 0.5 * kCellMm * std::sqrt(1 + 0.25 * 0.25)) << i;
    ASSERT_NEAR(proxy.z, 20 + 0.25 * proxy.x, 0.002) << "the proxy lies on the surface";
  }
}

TEST(ProxyGraphMethods, TheForceIsStiffnessTimesTheDistanceToTheSurface) {
  const auto frames = planeFrames(20, 0.25, 0);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.25, 0, 1));
  for (const char* name : {"proxy-graph", "modified-proxy-graph"}) {
    const auto m = method(name, {.stiffness_n_per_mm = 0.8});
    double squares = 0;
    int ticks = 0;
    for (int i = 0; i < 400; ++i) {
      const glm::dvec3 on_plane(-20 + 0.1 * i, 0.03 * i, 20 + 0.25 * (-20 + 0.1 * i));
      const double depth = std::min(3.0, -1.01 + 0.05 * i);  // comes in from 1 mm outside
      const Touch touch = m->update(on_plane - depth * normal, w, {});
      ASSERT_EQ(touch.contact, depth > 0) << name << ' ' << i;
      if (depth < 3) continue;
      squares += std::pow(glm::length(touch.force_n - 0.8 * 3.0 * normal), 2);
      ++ticks;
    }
    EXPECT_LE(std::sqrt(squares / ticks), 0.05 * 0.8 * 3.0 * 2) << name;  // half a cell aside is 0.44 of 3 mm at worst
    EXPECT_GT(ticks, 300);
  }
}

struct RiseCount {
  int below = 0, touched = 0;
};

// A finger rests at z = 12; the plane rises from 10 past it by `per_tick` mm each tick.
RiseCount countContacts(TouchMethod& m, double per_tick) {
  const auto frames = planeFrames(10, 0, 20);  // 20 mm in 1 s; time runs at the speed that is asked for
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const glm::dvec3 hip(3.3, -7.1, 12);
  RiseCount count;
  for (double z = 10; z <= 30; z += per_tick) {
    const Touch touch = m.update(hip, w, mediaTime((z - 10) / 20));
    if (z <= hip.z + 0.001) continue;
    ++count.below;
    count.touched += touch.contact ? 1 : 0;
  }
  return count;
}

TEST(ModifiedProxyGraph, KeepsContactInEveryTickWhileTheSurfaceRisesThroughTheFinger) {
  for (const double per_tick : {0.01, 0.1, 1.0, 7.0}) {
    const auto m = method("modified-proxy-graph");
    const RiseCount count = countContacts(*m, per_tick);
    EXPECT_GT(count.below, 0);
    EXPECT_EQ(count.touched, count.below) << per_tick << " mm a tick";
  }
}

TEST(ProxyGraph, LosesARisingSurfaceAsThePaperSays) {
  const auto m = method("proxy-graph", {.time = TimeLaw::Linear});
  const RiseCount count = countContacts(*m, 0.1);
  EXPECT_GT(count.below, 100);
  EXPECT_LE(count.touched, 1);
}

TEST(ModifiedProxyGraph, KeepsContactOnATiltedPlaneThatRisesUnderASlidingFinger) {
  const auto frames = planeFrames(12, 0.3, 8);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const auto m = method("modified-proxy-graph");
  int lost = 0;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 0.001 * i;
    const glm::dvec3 hip(-10 + 0.02 * i, 4 * std::sin(0.01 * i),
                         12 + 0.3 * (-10 + 0.02 * i) + (i == 0 ? 1 : -2) + 8 * t);
    const bool contact = m->update(hip, w, mediaTime(t)).contact;
    lost += i > 0 && !contact ? 1 : 0;
    if (i == 0) {
      EXPECT_FALSE(contact);
    }
  }
  EXPECT_EQ(lost, 0);
}

TEST(ModifiedProxyGraph, FollowsASurfaceThatSinksAndLetsGoWhenItIsGone) {
  const auto frames = planeFrames(20, 0, -10);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const auto m = method("modified-proxy-graph", {.stiffness_n_per_mm = 1.0});
  EXPECT_FALSE(m->update({0, 0, 21}, w, mediaTime(0)).contact);
  for (int i = 0; i <= 900; ++i) {
    const double surface = 20 - 0.01 * i;
    const Touch touch = m->update({0, 0, 15}, w, mediaTime(0.001 * i));
    if (std::abs(surface - 15) > 0.001) {
      ASSERT_EQ(touch.contact, surface > 15) << i;
    }
    ASSERT_NEAR(touch.force_n.z, std::max(surface - 15, 0.0), 0.02);
  }
}

TEST(ModifiedProxyGraph, AFingerThatStartsInsideIsFreeUntilItHasComeOut) {
  const auto frames = planeFrames(20, 0, 0);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const auto m = method("modified-proxy-graph");
  for (const double z : {15.0, 10.0, 19.0}) EXPECT_FALSE(m->update({0, 0, z}, w, {}).contact);
  EXPECT_FALSE(m->update({0, 0, 20.5}, w, {}).contact);
  EXPECT_TRUE(m->update({0, 0, 19.5}, w, {}).contact);
}

TEST(ModifiedProxyGraph, ForgetsTheContactWhereTheFilmIsNotContinuous) {
  const auto frames = planeFrames(20, 0, 0);
  SurfaceWindow w = makeWindow(frames, kVolume);
  const auto m = method("modified-proxy-graph");
  EXPECT_FALSE(m->update({0, 0, 21}, w, {}).contact);
  EXPECT_TRUE(m->update({0, 0, 18}, w, {}).contact);
  w.epoch = 1;
  EXPECT_FALSE(m->update({0, 0, 18}, w, {}).contact);
  EXPECT_FALSE(m->update({0, 0, 21}, w, {}).contact);
  EXPECT_TRUE(m->update({0, 0, 18}, w, {}).contact);
  m->reset();
  EXPECT_FALSE(m->update({0, 0, 18}, w, {}).contact);
}

TEST(ModifiedProxyGraph, LetsTheFingerThroughWhereTheForceJumps) {
  // The surface jumps from 20 to 38 mm between two ticks (a cut): 1 N becomes 10 N.
  std::vector<Frame> frames;
  for (int k = 0; k < 2; ++k) {
    frames.push_back(
        makeReliefFrame(kCols, kRows, kVolume, mediaTime(k), [&](double, double) { return 20.0 + 18 * k; }));
  }
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const auto guarded = method("modified-proxy-graph", {.time = TimeLaw::Hold, .jump_threshold = true});
  const auto open = method("modified-proxy-graph", {.time = TimeLaw::Hold, .jump_threshold = false});
  for (TouchMethod* m : {guarded.get(), open.get()}) {
    for (double z = 20.5; z > 18; z -= 0.2) static_cast<void>(m->update({0, 0, z}, w, mediaTime(0.5)));
    EXPECT_TRUE(m->update({0, 0, 18}, w, mediaTime(0.9)).contact);
  }
  EXPECT_NEAR(open->update({0, 0, 18}, w, mediaTime(1)).force_n.z, 10.0, 0.05);
  const Touch through = guarded->update({0, 0, 18}, w, mediaTime(1));
  EXPECT_FALSE(through.contact);
  EXPECT_EQ(through.force_n, glm::dvec3(0));
  EXPECT_EQ(through.proxy_mm, glm::dvec3(0, 0, 18));
  EXPECT_FALSE(guarded->update({0, 0, 18}, w, mediaTime(1.1)).contact);
}

TEST(ProxyBlend, LeavesTheOldSceneAtTheCut) {
  const auto frames = planeFrames(20, 0, -5);
  SurfaceWindow w = makeWindow(frames, kVolume);
  w.frames[1].shot = 1;
  const auto m = method("proxy-blend");
  for (const double z : {21.0, 18.0, 14.0}) static_cast<void>(m->update({0, 0, z}, w, mediaTime(0.5)));
  EXPECT_NEAR(m->update({0, 0, 14}, w, mediaTime(0.99)).force_n.z, 3, 0.01);
  EXPECT_NEAR(m->update({0, 0, 14}, w, mediaTime(1.01)).force_n.z, 0.5, 0.01);
}

TEST(ModifiedProxyGraph, HasNoSurfaceOutsideThePictureNorInHoles) {
  const std::vector<Frame> frames{
      test::makeGrayFrame(kCols, kRows, 8, {}, [](int c, int) { return c < 60 ? 0 : 128; })};
  const SurfaceWindow w = makeWindow(frames, kVolume, {.invalid = 0});
  const double x_of_hole = GridMapping(kVolume, kCols, kRows).x(30),
               x_of_plane = GridMapping(kVolume, kCols, kRows).x(90);
  for (const glm::dvec3 place : {glm::dvec3(90, 0, 0), glm::dvec3(0, -60, 0), glm::dvec3(x_of_hole, 0, 0)}) {
    const auto m = method("modified-proxy-graph");
    for (double z = 30; z > -10; z -= 0.5) {
      ASSERT_FALSE(m->update({place.x, place.y, z}, w, {}).contact) << place.x << ' ' << z;
    }
  }
  const auto m = method("modified-proxy-graph");
  EXPECT_FALSE(m->update({x_of_plane, 0, 21}, w, {}).contact);
  EXPECT_TRUE(m->update({x_of_plane, 0, 19}, w, {}).contact);
  EXPECT_FALSE(m->update({90, 0, 19}, w, {}).contact) << "a finger that has left the picture is free";
}

TEST(ModifiedProxyGraph, SurvivesAnEmptyWindowAndPicturesTooSmallForATriangle) {
  const auto m = method("modified-proxy-graph");
  EXPECT_FALSE(m->update({0, 0, -5}, SurfaceWindow{}, {}).contact);
  for (const auto& [cols, rows] : {std::pair(1, 1), std::pair(1, 9), std::pair(9, 1)}) {
    const std::vector<Frame> frames{test::makeGrayFrame(cols, rows, 8, {}, [](int, int) { return 200; })};
    const SurfaceWindow w = makeWindow(frames, kVolume, {});
    EXPECT_FALSE(m->update({0, 0, 39}, w, {}).contact);
    EXPECT_FALSE(m->update({0, 0, 1}, w, {}).contact);
  }
}

TEST(ProxyGraphMethods, AreFiniteAndOnTheSurfaceOverRandomDepthAndAWildFinger) {
  std::mt19937 random(77);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const char* name : {"proxy-graph", "modified-proxy-graph"}) {
    int contacts = 0;
    for (int round = 0; round < 60; ++round) {
      std::vector<Frame> frames;
      for (int k = 0; k < 4; ++k) {
        frames.push_back(
            test::makeGrayFrame(40, 30, 8, mediaTime(0.04 * k), [&](int, int) { return unit(random) * 256; }));
      }
      const SurfaceWindow w = makeWindow(frames, kVolume, {.invalid = 3});
      const auto m = method(name);
      for (int i = 0; i < 200; ++i) {
        const glm::dvec3 hip((unit(random) - 0.5) * 200, (unit(random) - 0.5) * 130, unit(random) * 60 - 10);
        const MediaTime now = mediaTime(0.001 * i - 0.02);
        const Touch touch = m->update(hip, w, now);
        ASSERT_TRUE(std::isfinite(glm::length(touch.force_n) + glm::length(touch.proxy_mm)));
        if (!touch.contact) {
          ASSERT_EQ(touch.proxy_mm, hip);
          ASSERT_EQ(touch.force_n, glm::dvec3(0));
          continue;
        }
        ++contacts;
        const SurfaceInTime s(w, now, std::string_view(name) == "proxy-graph" ? TimeLaw::Hold : TimeLaw::Linear);
        ASSERT_NEAR(touch.proxy_mm.z, surfaceHeight(s, touch.proxy_mm.x, touch.proxy_mm.y), 1e-6);
      }
    }
    EXPECT_GT(contacts, 1000) << name;
  }
}

TEST(MakeMethod, KnowsTheNamesThatItListsAndNoOther) {
  EXPECT_NE(makeMethod("proxy-graph", {}), nullptr);
  EXPECT_NE(makeMethod(kDefaultMethod, {}), nullptr);
  EXPECT_EQ(makeMethod("proxy graph", {}), nullptr);
}

TEST(ProxyGraphMethods, APositionThatIsNoNumberIsOneTickWithoutContactAndNoMore) {
  const auto frames = planeFrames(20, 0.25, 0);
  const SurfaceWindow w = makeWindow(frames, kVolume);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const char* name : {"modified-proxy-graph", "proxy-graph", "proxy-blend"}) {
    const auto m = method(name);
    EXPECT_FALSE(m->update({0, 0, 25}, w, {}).contact);
    EXPECT_FALSE(m->update({nan, 0, 25}, w, {}).contact) << name;
    EXPECT_FALSE(m->update({0, 0, 25}, w, {}).contact) << name;
    EXPECT_NEAR(m->update({0, 0, 18}, w, {}).force_n.z, 0.94, 0.05) << name << ": 2 mm, and K is 0.5";
  }
}

}  // namespace
}  // namespace relievo
