// SPDX-License-Identifier: Apache-2.0
// The relief between frames, and the search for the first crossing of a segment with it.
#include "app/haptics/baseline/surface_in_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "app/haptics/baseline/segment_search.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

using test::makeGrayFrame;
using test::makeWindow;

constexpr DisplayVolume kVolume{80, 60, 40};

SurfaceWindow risingWindow() {
  std::vector<Frame> frames;
  // Irregular times: 0, 40, 60, 100 ms at codes 100, 200, 150, 250 of 8 bits.
  const std::array<std::pair<double, unsigned>, 4> steps{{{0.0, 100}, {0.04, 200}, {0.06, 150}, {0.1, 250}}};
  for (const auto& [t, code] : steps) {
    frames.push_back(makeGrayFrame(4, 3, 8, mediaTime(t), [code = code](int, int) { return code; }));
  }
  return makeWindow(frames, kVolume, {});
}

double heightAt(const SurfaceWindow& window, double t, TimeLaw law) {
  return SurfaceInTime(window, mediaTime(t), law).vertexHeight(1, 1);
}

TEST(SurfaceInTime, HoldShowsTheNewestFrameThatHasBegun) {
  const SurfaceWindow w = risingWindow();
  const double unit = 40.0 / 255;
  EXPECT_DOUBLE_EQ(heightAt(w, -1, TimeLaw::Hold), 100 * unit);
  EXPECT_DOUBLE_EQ(heightAt(w, 0.0399, TimeLaw::Hold), 100 * unit);
  EXPECT_DOUBLE_EQ(heightAt(w, 0.04, TimeLaw::Hold), 200 * unit);
  EXPECT_DOUBLE_EQ(heightAt(w, 9, TimeLaw::Hold), 250 * unit);
}

TEST(SurfaceInTime, AFrameThatIsSaidToRepeatIsNotRead) {
  SurfaceWindow w = risingWindow();
  w.frames[1].repeats = true;
  EXPECT_DOUBLE_EQ(heightAt(w, 0.02, TimeLaw::Linear), 100 * 40.0 / 255);
}

TEST(SurfaceInTime, TheOldSceneStandsUntilTheCut) {
  SurfaceWindow w = risingWindow();
  w.frames[2].shot = w.frames[3].shot = 1;
  EXPECT_DOUBLE_EQ(heightAt(w, 0.059, TimeLaw::Linear), 200 * 40.0 / 255);
  EXPECT_NEAR(heightAt(w, 0.08, TimeLaw::Linear), 200 * 40.0 / 255, 1e-9) << "halfway from 150 to 250";
  const SurfaceInTime paper(w, mediaTime(0.05), TimeLaw::Linear, Cuts::Unknown);
  EXPECT_NEAR(paper.vertexHeight(0, 0), 175 * 40.0 / 255, 1e-9) << "halfway from 200 to 150";
}

TEST(SurfaceInTime, LinearFollowsTheTimestampsNotANominalRate) {
  const SurfaceWindow w = risingWindow();
  const double unit = 40.0 / 255;
  EXPECT_NEAR(heightAt(w, 0.01, TimeLaw::Linear), 125 * unit, 1e-9);
  EXPECT_NEAR(heightAt(w, 0.05, TimeLaw::Linear), 175 * unit, 1e-9);
  EXPECT_NEAR(heightAt(w, 0.09, TimeLaw::Linear), 225 * unit, 1e-9);
  EXPECT_NEAR(heightAt(w, -1, TimeLaw::Linear), 100 * unit, 1e-9);
  EXPECT_NEAR(heightAt(w, 9, TimeLaw::Linear), 250 * unit, 1e-9);
}

TEST(SurfaceInTime, ACellIsSplitFromItsUpperLeftToItsLowerRightCorner) {
  // One cell: corners 0, 40 on top; 0, 0 below. On the diagonal the height is interpolated between (0,0)=0 and (1,1)=0.
  const std::vector<Frame> frames{makeGrayFrame(2, 2, 8, {}, [](int c, int r) { return c == 1 && r == 0 ? 255 : 0; })};
  const SurfaceWindow w = makeWindow(frames, kVolume, {});
  const SurfaceInTime s(w, {}, TimeLaw::Hold);
  const GridMapping& g = s.grid();
  EXPECT_NEAR(surfaceHeight(s, g.x(0.5), g.y(0.5)), 0, 1e-9);
  EXPECT_NEAR(surfaceHeight(s, g.x(0.75), g.y(0.25)), 20, 1e-9);
  EXPECT_NEAR(surfaceHeight(s, g.x(0.25), g.y(0.75)), 0, 1e-9);
  EXPECT_TRUE(std::isnan(surfaceHeight(s, g.x(-0.01), g.y(0.5))));
  EXPECT_TRUE(std::isnan(surfaceHeight(s, g.x(0.5), g.y(1.01))));
}

// Brute force reference: every triangle against the whole segment.
std::optional<double> bruteForceCrossing(const SurfaceInTime& s, glm::dvec3 from, glm::dvec3 to) {
  const GridMapping& g = s.grid();
  const glm::dvec3 a(g.u(from.x), g.v(from.y), from.z), d = glm::dvec3(g.u(to.x), g.v(to.y), to.z) - a;
  std::optional<double> first;
  for (int r = 0; r + 1 < s.rows(); ++r) {
    for (int c = 0; c + 1 < s.cols(); ++c) {
      for (const bool right : {false, true}) {
        const double z00 = s.vertexHeight(c, r), z11 = s.vertexHeight(c + 1, r + 1);
        const double zc = right ? s.vertexHeight(c + 1, r) : s.vertexHeight(c, r + 1);
        const double zu = right ? zc - z00 : z11 - zc, zv = right ? z11 - zc : zc - z00;
        const double h0 = a.z - (z00 + zu * (a.x - c) + zv * (a.y - r)), slope = d.z - zu * d.x - zv * d.y;
        if (!(slope < 0)) continue;  // only from above to below; NaN at a hole
        const double t = h0 / -slope;
        if (!(t >= 0 && t < 1)) continue;
        const double fu = a.x + d.x * t - c, fv = a.y + d.y * t - r, e = 1e-9;
        const bool inside = fu >= -e && fu <= 1 + e && fv >= -e && fv <= 1 + e && (right ? fu >= fv - e : fu <= fv + e);
        if (inside && (!first || t < *first)) first = t;
      }
    }
  }
  return first;
}

TEST(SegmentSearch, FindsWhatATestOfEveryTriangleFindsOnRandomReliefsWithHoles) {
  std::mt19937 random(20061);
  std::uniform_real_distribution<double> unit(0, 1);
  int hits = 0, misses = 0;
  for (int round = 0; round < 4000; ++round) {
    const int cols = 2 + static_cast<int>(unit(random) * 9), rows = 2 + static_cast<int>(unit(random) * 9);
    const std::vector<Frame> frames{makeGrayFrame(cols, rows, 8, {}, [&](int, int) {
      return unit(random) < 0.05 ? 0 : 1 + static_cast<int>(unit(random) * 254);
    })};
    const SurfaceWindow w = makeWindow(frames, kVolume, {.invalid = 0});
    const SurfaceInTime s(w, {}, TimeLaw::Hold);
    const auto point = [&](double z) { return glm::dvec3((unit(random) - 0.5) * 100, (unit(random) - 0.5) * 75, z); };
    const glm::dvec3 from = point(unit(random) * 60 - 5),
                     to = round % 3 == 0 ? point(0) : point(unit(random) * 60 - 10);
    const auto found = firstCrossing(s, from, to);
    const auto truth = bruteForceCrossing(s, from, to);
    ASSERT_EQ(found.has_value(), truth.has_value()) << "round " << round;
    if (!truth) {
      ++misses;
      continue;
    }
    ++hits;
    const glm::dvec3 expected = from + (to - from) * *truth;
    ASSERT_NEAR(found->point_mm.x, expected.x, 1e-6) << "round " << round;
    ASSERT_NEAR(found->point_mm.z, expected.z, 1e-6) << "round " << round;
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(misses, 500);
}

TEST(SegmentSearch, SeesSegmentsThatRunAlongGridLinesAndThroughVertices) {
  const std::vector<Frame> frames{makeGrayFrame(9, 9, 8, {}, [](int, int) { return 128; })};
  const SurfaceWindow w = makeWindow(frames, kVolume, {});
  const SurfaceInTime s(w, {}, TimeLaw::Hold);
  const GridMapping& g = s.grid();
  const double z = 40.0 * 128 / 255;
  const auto at = [&](double u, double v, double height) { return glm::dvec3(g.x(u), g.y(v), height); };
  const std::array<std::pair<glm::dvec3, glm::dvec3>, 6> segments{{
      {at(2, 3, z + 1), at(2, 3, z - 1)},  // straight down onto a vertex
      {at(2, 3, z + 1), at(6, 3, z - 1)},  // along a row
      {at(2, 1, z + 1), at(2, 5, z - 1)},  // along a column
      {at(1, 1, z + 1), at(5, 5, z - 1)},  // along diagonals
      {at(5, 1, z + 1), at(1, 5, z - 1)},  // across them, through vertices
      {at(0, 0, z + 1), at(8, 8, z - 1)},  // from corner to corner
  }};
  for (const auto& [from, to] : segments) {
    const auto found = firstCrossing(s, from, to);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->point_mm.z, z, 1e-9);
    EXPECT_NEAR(found->point_mm.x, 0.5 * (from.x + to.x), 1e-9);
    EXPECT_FALSE(firstCrossing(s, to, from).has_value()) << "from below to above is no contact";
  }
}

}  // namespace
}  // namespace relievo
