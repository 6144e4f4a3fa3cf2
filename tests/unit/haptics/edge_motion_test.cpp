// SPDX-License-Identifier: Apache-2.0
// Where an edge near the finger moves from one frame to the next, and changes that only resemble that.
#include "app/haptics/method/edge_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};

template <class Height>
Frame frameOf(Height&& height) {
  return test::makeReliefFrame(720, 486, kVolume, {}, height);
}
glm::dvec2 wayBetween(const Frame& from, const Frame& to, const glm::dvec2& place,
                      const DepthCalibration& calibration = {.bits = 16}) {
  return edgeMotion(test::surfaceOf(from, kVolume, calibration).field, test::surfaceOf(to, kVolume, calibration).field,
                    place.x, place.y);
}

TEST(EdgeMotion, FindsTheWayOfAnEdgeAcrossItselfAndNoOther) {
  const auto step = [](double at, double lift) {
    return frameOf([=](double x, double y) { return (x > at + 0.3 * y ? 25.0 : 10.0) + lift + 0.1 * x; });
  };
  const Frame here = step(0, 0), there = step(1.6, 0), lifted = step(0, 1.0), both = step(1.6, 1.0), gone = step(30, 0);
  // the component of a sideways displacement that is perpendicular to the edge
  const glm::dvec2 across = 1.6 / (1 + 0.09) * glm::dvec2(1, -0.3);
  for (const glm::dvec2 place : {glm::dvec2(0.8, 0), glm::dvec2(-1.5, 1), glm::dvec2(2.5, -2)}) {
    const auto way = [&](const Frame& to) { return wayBetween(here, to, place); };
    EXPECT_LT(glm::length(way(there) - across), 0.25);
    EXPECT_LT(glm::length(way(both) - across), 0.35) << "also when the whole is lifted by a little";
    EXPECT_EQ(way(here), glm::dvec2(0));
    EXPECT_EQ(way(lifted), glm::dvec2(0)) << "what is lifted has not moved sideways";
    EXPECT_EQ(way(gone), glm::dvec2(0)) << "what is gone has not moved";
  }
  EXPECT_EQ(wayBetween(here, there, {40, 0}), glm::dvec2(0)) << "no edge in sight";
}

TEST(EdgeMotion, WhatAppearsBesideAnEdgeThatStandsIsNoMotion) {
  // A second wall, 2 mm wide, appears 2 mm in front of the first: it sweeps the same volume as a displacement of 2 mm.
  const auto wall = [](double from, double to) {
    return frameOf([=](double x, double y) {
      const double q = x - 0.3 * y;
      return q > 0 || (q > from && q < to) ? 25.0 : 10.0;
    });
  };
  const Frame before = wall(0, 0), beside = wall(-4, -2), moved = wall(-2, 0);
  EXPECT_EQ(wayBetween(before, beside, {0.5, 0}), glm::dvec2(0));
  EXPECT_LT(glm::length(wayBetween(before, moved, {0.5, 0}) + 2 / (1 + 0.09) * glm::dvec2(1, -0.3)), 0.25)
      << "the same volume";
}

TEST(EdgeMotion, TheRimOfAHoleIsAnEdge) {
  const DepthCalibration holes{.bits = 16, .invalid = 0};
  const auto rim = [](double at) { return frameOf([=](double x, double y) { return x > at + 0.3 * y ? 20.0 : 0.0; }); };
  const glm::dvec2 way = wayBetween(rim(0), rim(1.6), {0.8, 0}, holes);
  EXPECT_LT(glm::length(way - 1.6 / (1 + 0.09) * glm::dvec2(1, -0.3)), 0.25) << way.x;
}

}  // namespace
}  // namespace relievo
