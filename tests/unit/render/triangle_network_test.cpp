// SPDX-License-Identifier: Apache-2.0
// The irregular network against its heights: complete, without cracks, and within its error.
#include "app/render/relief/triangle_network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160.0, 108.0, 40.0};
constexpr float kNoJump = 1000.0F;

using Height = std::function<double(double x, double y)>;

double wave(double x, double y) {
  return 20 + 8 * std::sin(0.11 * x) * std::cos(0.09 * y) + 0.05 * x;
}

HeightLattice latticeOf(int cols, int rows, const Height& height, int most_across = 4096) {
  const Frame frame = test::makeReliefFrame(cols, rows, kVolume, MediaTime{}, height);
  HeightLattice lattice;
  lattice.read(HeightField::make(frame, {.bits = 16}, kVolume).value(), most_across);
  return lattice;
}

struct Point {
  int i, j;
};
Point at(const HeightLattice& lattice, std::uint32_t vertex) {
  return {static_cast<int>(vertex) % lattice.cols(), static_cast<int>(vertex) / lattice.cols()};
}

// Twice the signed area in cells, y down: negative if it is counterclockwise for the viewer.
int area(Point a, Point b, Point c) {
  return (b.i - a.i) * (c.j - a.j) - (c.i - a.i) * (b.j - a.j);
}

TriangleNetwork::Triangle onLattice(const TriangleNetwork& network, const TriangleNetwork::Triangle& places) {
  const auto& vertices = network.vertices();
  return {vertices[places.a], vertices[places.b], vertices[places.c]};
}

// The largest distance along z between a triangle and the lattice's points in it; how often each point lies inside or
// on the border of one.
struct Fit {
  double worst_mm = 0;
  std::vector<int> covered;
};
Fit fitOf(const HeightLattice& lattice, const TriangleNetwork& network) {
  Fit fit;
  fit.covered.assign(lattice.size(), 0);
  const auto z = [&](std::size_t vertex) { return static_cast<double>(lattice.heights()[vertex]); };
  for (const auto& places : network.triangles()) {
    const auto triangle = onLattice(network, places);
    const Point a = at(lattice, triangle.a), b = at(lattice, triangle.b), c = at(lattice, triangle.c);
    const int whole = area(a, b, c);
    EXPECT_LT(whole, 0) << "turned over";
    for (int j = std::min({a.j, b.j, c.j}); j <= std::max({a.j, b.j, c.j}); ++j) {
      for (int i = std::min({a.i, b.i, c.i}); i <= std::max({a.i, b.i, c.i}); ++i) {
        const Point p{i, j};
        const int of_a = area(p, b, c), of_b = area(a, p, c), of_c = area(a, b, p);
        if (std::max({of_a, of_b, of_c}) > 0) continue;
        const std::size_t here = static_cast<std::size_t>(j) * lattice.cols() + i;
        ++fit.covered[here];
        const double plane = (of_a * z(triangle.a) + of_b * z(triangle.b) + of_c * z(triangle.c)) / whole;
        fit.worst_mm = std::max(fit.worst_mm, std::abs(plane - z(here)));
      }
    }
  }
  return fit;
}

// Every side belongs to two triangles with opposite directions, except on the lattice's border: no vertex lies in the
// middle of another triangle's side.
int openSides(const HeightLattice& lattice, const TriangleNetwork& network) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& places : network.triangles()) {
    const auto [a, b, c] = onLattice(network, places);
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) ++sides[{from, to}];
  }
  int open = 0;
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    const Point from = at(lattice, side.first), to = at(lattice, side.second);
    const bool border = (from.i == to.i && (from.i == 0 || from.i == lattice.cols() - 1)) ||
                        (from.j == to.j && (from.j == 0 || from.j == lattice.rows() - 1));
    if (!border && !sides.contains({side.second, side.first})) ++open;
  }
  return open;
}

TriangleNetwork networkOf(HeightLattice lattice, double error_mm) {
  CutCells cuts;
  cuts.find(lattice, kNoJump);
  TriangleNetwork network;
  network.measure(lattice, cuts);
  network.triangulate(static_cast<float>(error_mm));
  return network;
}

// Cut and finer, then whole and coarser, then another size and back.
TEST(TriangleNetwork, NothingIsLeftOfAnotherPicture) {
  const Height step = [](double x, double y) { return wave(x, y) + (x > 0.3 * y ? 9 : 0); };
  const std::array lattices{latticeOf(129, 65, step), latticeOf(129, 65, wave), latticeOf(65, 129, wave),
                            latticeOf(97, 33, step), latticeOf(129, 65, step)};
  TriangleNetwork network;
  float error_mm = 0.05F;
  for (HeightLattice lattice : lattices) {
    CutCells cuts;
    cuts.find(lattice, lattice.jumpMm());
    TriangleNetwork fresh;
    for (TriangleNetwork* each : {&network, &fresh}) {
      each->measure(lattice, cuts);
      each->triangulate(error_mm);
    }
    EXPECT_TRUE(std::ranges::equal(network.vertices(), fresh.vertices()));
    EXPECT_TRUE(std::ranges::equal(network.triangles(), fresh.triangles(), [](const auto& a, const auto& b) {
      return a.a == b.a && a.b == b.b && a.c == b.c;
    }));
    EXPECT_EQ(network.slots(), fresh.slots());
    error_mm *= 1.5F;
  }
}

TEST(TriangleNetwork, PlaneTakesTwoTrianglesATile) {
  const HeightLattice lattice = latticeOf(129, 65, [](double x, double y) { return 20 + 0.1 * x - 0.05 * y; });
  ASSERT_EQ(lattice.tile(), 32);
  EXPECT_EQ(networkOf(lattice, 0.01).triangles().size(), 2U * 4 * 2);
}

TEST(TriangleNetwork, KeepsWithinItsErrorEverywhere) {
  for (const auto& [cols, rows] : {std::pair{129, 65}, {200, 131}, {97, 33}, {720, 486}}) {
    const HeightLattice lattice = latticeOf(cols, rows, wave);
    for (const double error_mm : {2.0, 0.5, 0.1, 0.02}) {
      const Fit fit = fitOf(lattice, networkOf(lattice, error_mm));
      EXPECT_LE(fit.worst_mm, error_mm + 1e-4) << cols << " x " << rows;
      EXPECT_GT(fit.worst_mm, 0.02 * error_mm) << "a bound that is far from the truth";
    }
  }
}

TEST(TriangleNetwork, KeepsWithinItsErrorOnNoise) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(0, 4);
  const HeightLattice lattice = latticeOf(129, 65, [&](double x, double y) { return wave(x, y) + noise(random); });
  for (const double error_mm : {8.0, 3.0, 1.0}) {
    EXPECT_LE(fitOf(lattice, networkOf(lattice, error_mm)).worst_mm, error_mm + 1e-4);
  }
}

TEST(TriangleNetwork, CoversEveryPointWithoutCracks) {
  for (const double error_mm : {2.0, 0.3, 0.03}) {
    const HeightLattice lattice = latticeOf(200, 131, wave);
    const TriangleNetwork network = networkOf(lattice, error_mm);
    const Fit fit = fitOf(lattice, network);
    EXPECT_EQ(std::count(fit.covered.begin(), fit.covered.end(), 0), 0);
    EXPECT_EQ(openSides(lattice, network), 0);
    int twice_area = 0;
    for (const auto& places : network.triangles()) {
      const auto [a, b, c] = onLattice(network, places);
      twice_area -= area(at(lattice, a), at(lattice, b), at(lattice, c));
    }
    EXPECT_EQ(twice_area, 2 * (lattice.cols() - 1) * (lattice.rows() - 1));
  }
}

TEST(TriangleNetwork, FinerErrorTakesMoreTriangles) {
  const HeightLattice lattice = latticeOf(720, 486, wave);
  std::size_t before = 0;
  for (const double error_mm : {2.0, 0.5, 0.1, 0.02}) {
    const std::size_t count = networkOf(lattice, error_mm).triangles().size();
    EXPECT_GT(count, before);
    before = count;
  }
  EXPECT_LT(networkOf(lattice, 0.5).triangles().size(), 2U * 719 * 485 / 50);
}

// A disc 20 mm above its ground: no triangle has corners on both, and the gaps between the triangles are exactly the
// cells between the two.
TEST(TriangleNetwork, NoTriangleLiesAcrossASilhouette) {
  const auto on_disc = [](double x, double y) { return std::hypot(x - 10, y + 5) < 31; };
  HeightLattice lattice =
      latticeOf(257, 161, [&](double x, double y) { return (on_disc(x, y) ? 25.0 : 5.0) + 0.02 * x; });
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  TriangleNetwork network;
  network.measure(lattice, cuts);
  network.triangulate(0.5F);
  const auto isHigh = [&](std::uint32_t vertex) { return lattice.heights()[vertex] > 15; };
  for (const auto& places : network.triangles()) {
    const auto [a, b, c] = onLattice(network, places);
    ASSERT_EQ(isHigh(a), isHigh(b));
    ASSERT_EQ(isHigh(b), isHigh(c));
  }
  EXPECT_LE(fitOf(lattice, network).worst_mm, 0.5);
  int twice_area = 0;
  for (const auto& places : network.triangles()) {
    const auto [a, b, c] = onLattice(network, places);
    twice_area -= area(at(lattice, a), at(lattice, b), at(lattice, c));
  }
  const auto cut = static_cast<int>(cuts.cells().size());
  EXPECT_EQ(twice_area, 2 * ((lattice.cols() - 1) * (lattice.rows() - 1) - cut));
  EXPECT_GT(cut, 200);
  for (const std::uint32_t cell : cuts.cells()) {
    const auto width = static_cast<std::uint32_t>(lattice.cols());
    const int high = isHigh(cell) + isHigh(cell + 1) + isHigh(cell + width) + isHigh(cell + width + 1);
    EXPECT_TRUE(high > 0 && high < 4);
  }
}

TEST(CutCells, SmearedJumpHasNothingBetweenItsSides) {
  // 5, 5, 9, 16, 22, 25, 25 across; samples 0.6 mm apart.
  const auto ramp = [](double x, double) {
    constexpr std::array kHeights{9.0, 16.0, 22.0};
    const int k = static_cast<int>(std::floor(x / (160.0 / 257)));
    return k < 0 ? 5.0 : k > 2 ? 25.0 : kHeights[static_cast<std::size_t>(k)];
  };
  HeightLattice lattice = latticeOf(257, 161, ramp);
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  EXPECT_EQ(cuts.cells().size(), 161U - 1 + static_cast<unsigned>(lattice.rows() - 161)) << "one in each row";
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const double z = static_cast<double>(lattice.heights()[i]);
    ASSERT_TRUE(std::abs(z - 5) < 0.01 || std::abs(z - 25) < 0.01) << z;
  }
}

TEST(CutCells, AJumpThatIsSmearedDownwardHasNothingBetweenItsSidesEither) {
  const auto ramp = [](double, double y) {
    constexpr std::array kHeights{9.0, 16.0, 22.0};
    const int k = static_cast<int>(std::floor(-y / (108.0 / 161)));
    return k < 0 ? 5.0 : k > 2 ? 25.0 : kHeights[static_cast<std::size_t>(k)];
  };
  HeightLattice lattice = latticeOf(257, 161, ramp);
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  for (std::size_t i = 0; i < lattice.size(); ++i) {
    const double z = static_cast<double>(lattice.heights()[i]);
    ASSERT_TRUE(std::abs(z - 5) < 0.01 || std::abs(z - 25) < 0.01) << z;
  }
}

// Depth as a hue over YUV: of the second picture the chroma alone is another one. Magenta (255, 0, 255) and a blue
// (0, 130, 255) have the same luma.
TEST(HeightLattice, AHueThatChangesInItsChromaAloneIsReadAgain) {
  std::vector<std::uint8_t> luma(16 * 8, 105), u(16 * 8, 212), v(16 * 8, 235);
  Frame frame;
  frame.width = 16;
  frame.height = 8;
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Full;
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.plane = i, .step_bytes = 1, .bits = 8};
  frame.planes = {{{luma.data(), 16}, {u.data(), 16}, {v.data(), 16}}};
  const DepthCalibration hue{.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue};
  const auto field = HeightField::make(frame, hue, kVolume).value();
  HeightLattice lattice;
  lattice.read(field, 1024);
  const float magenta = lattice.heights()[0];
  std::ranges::fill(v, std::uint8_t{53});
  const auto next = HeightField::make(frame, hue, kVolume).value();
  lattice.read(next, 1024);
  EXPECT_NEAR(static_cast<double>(lattice.heights()[0]), next.heightMm(0, 0), 1e-3);
  EXPECT_GT(std::abs(lattice.heights()[0] - magenta), 5);
}

// An object whose border rows have many heights, beside an area without measurements: filling that area creates no
// edges.
TEST(CutCells, WhatFillsAHoleIsNotCut) {
  constexpr int kCols = 200, kRows = 120, kBorder = 80;
  constexpr std::uint32_t kHole = 0;
  std::mt19937 random(7);
  std::vector<std::uint32_t> borders(kRows);
  for (auto& each : borders) each = 20'000U + static_cast<std::uint32_t>(random() % 40'000U);
  const Frame frame = test::makeGrayFrame(kCols, kRows, 16, MediaTime{}, [&](int c, int r) {
    return c < kBorder ? borders[static_cast<std::size_t>(r)] : kHole;
  });
  HeightLattice lattice;
  lattice.read(HeightField::make(frame, {.bits = 16, .invalid = kHole}, kVolume).value(), 1024);
  CutCells cuts;
  cuts.find(lattice, lattice.jumpMm());
  EXPECT_GT(cuts.cells().size(), 1000U) << "between the rows of the thing";
  for (const std::uint32_t cell : cuts.cells()) {
    ASSERT_LT(lattice.column(static_cast<int>(cell) % lattice.cols()), kBorder);
  }
}

TEST(HeightLattice, StandsOnTrueSamplesFromTheFirstToTheLast) {
  for (const auto& [cols, rows] : {std::pair{720, 486}, {2, 2}, {3, 200}, {1920, 1080}, {33, 65}}) {
    const HeightLattice lattice = latticeOf(cols, rows, wave, 1024);
    EXPECT_EQ(lattice.column(0), 0);
    EXPECT_EQ(lattice.column(lattice.cols() - 1), cols - 1);
    EXPECT_EQ(lattice.row(lattice.rows() - 1), rows - 1);
    EXPECT_EQ((lattice.cols() - 1) % lattice.tile(), 0);
    EXPECT_LE(lattice.cols() - 1, 1024 + 32);
    const GridMapping grid(kVolume, cols, rows);
    for (int i = 1; i < lattice.cols(); ++i) {
      ASSERT_GE(lattice.column(i), lattice.column(i - 1));
      ASSERT_NEAR(lattice.x(i), grid.x(lattice.column(i)), 1e-4);
    }
    const std::size_t middle = lattice.size() / 2;
    const int i = static_cast<int>(middle) % lattice.cols(), j = static_cast<int>(middle) / lattice.cols();
    EXPECT_NEAR(lattice.heights()[middle], wave(grid.x(lattice.column(i)), grid.y(lattice.row(j))), 1e-3);
  }
}

// The filled row above limits the filling below it, and nothing else does.
TEST(HeightLattice, AHoleUnderAReadingIsFilledAnew) {
  constexpr std::uint32_t kHole = 0;
  struct Case {
    bool reading_between;
    int other_hole;  // in the row between them: far from the others, beside them, none
  };
  for (const auto& [reading_between, other_hole] : {Case{false, 60}, Case{true, 60}, Case{true, 28}, Case{true, -1}}) {
    const Frame frame = test::makeGrayFrame(65, 33, 8, MediaTime{}, [&](int c, int r) {
      if (c == other_hole && r == 11) return kHole;
      const bool in_hole = c >= 20 && c < 24;
      if (in_hole && (r == 10 || r == 12 || (r == 11 && !reading_between))) return kHole;
      return r < 12 ? 250U : 10U;
    });
    HeightLattice lattice;
    lattice.read(HeightField::make(frame, {.invalid = kHole}, kVolume).value(), 1024);
    const auto filled = static_cast<double>(lattice.heights()[12 * 65 + 22]);
    const double anew = 10 * 40 / 255.0, above = 250 * 40 / 255.0;
    EXPECT_NEAR(filled, reading_between ? anew : above - 0.5 * static_cast<double>(lattice.jumpMm()), 1e-3)
        << other_hole;
  }
}

// A film that changes partly from frame to frame, with changing holes, modified by sharpening after the reading, and
// with other pictures in between: each reading equals that of a fresh lattice.
TEST(HeightLattice, ReadsAfterOtherPicturesWhatItReadsAtFirst) {
  std::mt19937 random(11);
  constexpr std::uint32_t kHole = 7;
  for (const auto& [cols, rows, most_across] :
       {std::tuple{90, 70, 1024}, {65, 33, 1024}, {36, 31, 1024}, {200, 90, 96}}) {
    std::vector<std::uint32_t> codes(static_cast<std::size_t>(cols) * rows, 100), before = codes;
    HeightLattice lattice;
    CutCells cuts;
    for (int frame = 0; frame < 400; ++frame) {
      const std::size_t begin = random() % codes.size(), count = 1 + random() % (frame % 2 == 0 ? 3 : 60);
      for (std::size_t k = begin; k < std::min(begin + count, codes.size()); ++k) {
        codes[k] = frame % 3 == 0 ? kHole : static_cast<std::uint32_t>(60 + random() % 80);
      }
      const Frame picture = test::makeGrayFrame(
          cols, rows, 8, MediaTime{}, [&](int c, int r) { return codes[static_cast<std::size_t>(r) * cols + c]; });
      const DepthCalibration calibration{
          .polarity = frame % 10 < 8 ? DepthPolarity::NearIsHigh : DepthPolarity::NearIsLow, .invalid = kHole};
      const auto field = HeightField::make(picture, calibration, kVolume).value();
      const int across = frame % 50 / 3 == 14 ? std::min(cols, most_across) / 4 : most_across;  // drawing was too slow
      lattice.read(field, across);
      HeightLattice fresh;
      fresh.read(field, across);
      ASSERT_EQ(lattice.size(), fresh.size());
      ASSERT_TRUE(std::equal(lattice.heights(), lattice.heights() + lattice.size(), fresh.heights()))
          << cols << " columns, frame " << frame;
      cuts.find(lattice, lattice.jumpMm());
    }
  }
}

}  // namespace
}  // namespace relievo
