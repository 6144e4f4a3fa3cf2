// SPDX-License-Identifier: Apache-2.0
// The effect of the author's coding at its default quality on touch, by container and codec: heights in mm, and force
// in N against the oracle.
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "app/author/package/depth_coder.h"
#include "app/lab/film/requantised.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/measure/contenders.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/film_ways.h"

namespace relievo {
namespace {

using test::colorPicture;
using test::ReadFilm;
using test::Way;

class AuthorTouchLoss : public testing::TestWithParam<Way> {
 protected:
  test::TemporaryFolder folder_;
  [[nodiscard]] std::string path() const { return folder_ / (std::string("film") + GetParam().ending); }
};

// A nodding face at the default quality: the height of every sample, and the force on a finger that strokes it.
TEST_P(AuthorTouchLoss, IsSmallAndTold) {
  constexpr double kLengthS = 0.7;
  constexpr int kFaceCols = 240, kFaceRows = 162;
  const Way way = GetParam();
  const auto face = makeTrueSurface("face-nodding");
  std::vector<Frame> exact;
  for (int i = 0; i < 26; ++i) {
    exact.push_back(renderDepth(*face, {.cols = kFaceCols, .rows = kFaceRows, .bits = 16}, i));
  }
  DepthCoder coder({.bits = 16}, way.coding(8));
  FilmFormat format = test::formatOf(way, 8, coder.outcome());
  format.depth_width = kFaceCols;
  format.depth_height = kFaceRows;
  {
    auto writer = FilmWriter::create(path(), format);
    ASSERT_TRUE(writer) << writer.error().message;
    DepthPicture picture;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      ASSERT_TRUE(coder.encode(exact[k], picture));
      ASSERT_TRUE((*writer)->writeColor(colorPicture(test::kWayCols, test::kWayRows, static_cast<int>(k)), exact[k].pts,
                                        k == 0));
      ASSERT_TRUE((*writer)->writeDepth(picture, exact[k].pts, k == 0));
    }
    ASSERT_TRUE((*writer)->finish());
  }
  const ReadFilm film = test::readFilm(path());
  ASSERT_EQ(film.pairs.size(), exact.size());
  std::vector<Frame> felt;
  HeightErrorSum heights;
  const DepthCalibration& meaning = film.info.calibration.calibration;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    felt.push_back(film.pairs[k].depth);
    const auto field = HeightField::make(felt[k], meaning, TrueSurface::kVolume);
    const auto truth = HeightField::make(exact[k], {.bits = 16}, TrueSurface::kVolume);
    ASSERT_TRUE(field && truth);
    heights.add(*field, *truth);
  }
  const auto path_over_it = makeFingerPath(*face, {.duration_s = kLengthS});
  const auto truth = truthAlong(*face, path_over_it);
  const auto forceError = [&](std::span<const Frame> frames, const DepthCalibration& of) {
    const auto run = MemoryFilm::of(frames, of);
    return forceErrors(playPath(*run, *contender("relievo")->make(*run), path_over_it, truth), kSettledS).result();
  };
  const ForceError before = forceError(exact, {.bits = 16}), after = forceError(felt, meaning);
  std::printf(
      "%-5s %-5s %2d bits%-5s heights off by %.4f mm rms, %.3f mm at most; force by %.4f N (%.2f %%), before %.4f N\n",
      way.ending, name(way.codec), way.bits, way.flat ? " flat" : "", heights.rms(), heights.largest(), after.rms_n,
      after.rms_percent, before.rms_n);
  // People distinguish forces that differ by 10 %.
  EXPECT_LT(heights.rms(), 0.1);
  EXPECT_LT(after.rms_percent, 5);
  if (way.bits == 16) {
    EXPECT_NEAR(after.rms_n, before.rms_n, 1e-3);  // timestamps are rounded to whole milliseconds
  }
  EXPECT_EQ(after.lost_ticks, 0u);
}

INSTANTIATE_TEST_SUITE_P(Ways, AuthorTouchLoss, testing::ValuesIn(test::kWays));

}  // namespace
}  // namespace relievo
