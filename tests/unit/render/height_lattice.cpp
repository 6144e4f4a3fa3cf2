// SPDX-License-Identifier: Apache-2.0
// The samples under the network: smeared jumps, holes, and what is read again.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "app/render/relief/triangle_network.h"
#include "tests/support/film/depth_frames.h"
#include "tests/unit/render/network_fit.h"

namespace relievo::test {
namespace {

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

// Depth as a hue over YUV: only the chroma of the second picture differs. Magenta (255, 0, 255) and a blue (0, 130,
// 255) have the same luma.
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
  const Frame frame = makeGrayFrame(kCols, kRows, 16, MediaTime{}, [&](int c, int r) {
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
    const Frame frame = makeGrayFrame(65, 33, 8, MediaTime{}, [&](int c, int r) {
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
      const Frame picture = makeGrayFrame(cols, rows, 8, MediaTime{},
                                          [&](int c, int r) { return codes[static_cast<std::size_t>(r) * cols + c]; });
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
}  // namespace relievo::test
