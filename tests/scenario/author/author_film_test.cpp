// SPDX-License-Identifier: Apache-2.0
// relievo-author from end to end: colour and depth become one film, sample by sample.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <iterator>
#include <utility>

#include "app/author/author.h"
#include "app/scene/height_field.h"
#include "tests/scenario/author/author_film.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/mkv_patch.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using testing::HasSubstr;

TEST_F(AuthorFilm, BringsTwoFilesTogetherWithTheirCodesAndTimes) {
  const auto code = [](int c, int r, int k) { return static_cast<std::uint32_t>((c * 3 + r * 5 + k * 7) & 255); };
  const AuthorSummary summary = package(colorTrack(), depthTrack("gray", code));
  EXPECT_EQ(summary.totals.color.frames, 30u);
  EXPECT_EQ(summary.totals.depth.frames, 30u);
  EXPECT_EQ(summary.codes.samples, 30u * 64 * 48);
  EXPECT_THAT(summary.notes, testing::ElementsAre(HasSubstr("nothing says which end of the depth is near")));

  const Film film = readFilm(folder_ / "out.mkv");
  EXPECT_EQ(film.info.packing, Packing::Tracks);
  EXPECT_EQ(film.info.calibration.origin, CalibrationOrigin::ContainerTags);
  ASSERT_EQ(film.pairs.size(), 30u);
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_NEAR(toSeconds(film.pairs[k].color.pts), static_cast<double>(k) / 30, 6e-4);
    EXPECT_EQ(film.pairs[k].depth.pts, film.pairs[k].color.pts);
    for (const auto& [c, r] : {std::pair{0, 0}, {63, 47}, {31, 20}}) {
      EXPECT_EQ(film.code(k, c, r), static_cast<int>(code(c, r, static_cast<int>(k))));
    }
  }
}

// End to end: 16 bits with holes, inverse law and near low give the same heights in mm to within half a code.
TEST_F(AuthorFilm, KeepsTheHeightsThatTheDepthMeant) {
  const auto code = [](int c, int r, int) {
    return r == 0 && c < 8 ? 0u : static_cast<std::uint32_t>(1000 * c + 10 * r + 1);
  };
  SourceOptions source;
  source.command_line = {
      {"law", "inverse"}, {"near", "400"}, {"far", "4000"}, {"polarity", "near-low"}, {"invalid", "0"}};
  const AuthorSummary summary = package(colorTrack(), depthTrack("gray16le", code), source);
  EXPECT_EQ(summary.codes.holes, 30u * 8);

  const Film film = readFilm(folder_ / "out.mkv");
  const DepthCalibration& c = film.info.calibration.calibration;
  EXPECT_EQ(c.law, DepthLaw::Inverse);
  EXPECT_EQ(c.near_mm, 400);
  EXPECT_EQ(c.far_mm, 4000);
  EXPECT_EQ(c.invalid, CodeSet(0));
  const auto field = HeightField::make(film.pairs[5].depth, c, DisplayVolume::forPicture(64, 48)).value();
  const DepthCalibration meant{
      .law = DepthLaw::Inverse, .polarity = DepthPolarity::NearIsLow, .bits = 16, .near_mm = 400, .far_mm = 4000};
  for (const auto& [col, row] : {std::pair{0, 1}, {10, 40}, {33, 3}, {63, 47}}) {
    const double s = code(col, row, 5) / 65535.0;
    const double half_a_code = 0.5 / 255 + 1e-9;
    EXPECT_LE(field.heightMm(col, row), heightMm(meant, s - half_a_code, 40)) << col;
    EXPECT_GE(field.heightMm(col, row), heightMm(meant, s + half_a_code, 40)) << col;
  }
  EXPECT_TRUE(std::isnan(field.heightMm(7, 0)));
  EXPECT_FALSE(std::isnan(field.heightMm(8, 0)));
}

TEST_F(AuthorFilm, ExpandsTheLimitedRangeOfAVideo) {
  package(colorTrack(), depthTrack("yuv420p", [](int c, int, int) { return c < 21 ? 16u : c < 42 ? 126u : 235u; }));
  const Film film = readFilm(folder_ / "out.mkv");
  EXPECT_EQ(film.code(3, 5, 5), 0);
  EXPECT_EQ(film.code(3, 30, 5), 128);  // 110 x 255/219 = 128.08
  EXPECT_EQ(film.code(3, 60, 5), 255);
}

TEST_F(AuthorFilm, ReadsColourAndDepthPackedInOnePicture) {
  // Left half colour, right half depth of full range.
  ClipTrack packed = depthTrack(
      "yuv420p", [](int c, int r, int) { return static_cast<std::uint32_t>(c < 64 ? 40 : 3 * (c - 64) + r / 8); }, 128,
      48);
  packed.range = ColorRange::Full;
  makeClip(folder_ / "color.mkv", {packed});
  const auto summary = make({.url = folder_ / "color.mkv", .packing = Packing::SideBySide});
  ASSERT_TRUE(summary.has_value());
  EXPECT_EQ(summary->format.color_width, 64);
  EXPECT_EQ(summary->format.depth_width, 64);
  const Film film = readFilm(folder_ / "out.mkv");
  EXPECT_EQ(film.info.packing, Packing::Tracks);
  EXPECT_EQ(film.code(0, 10, 0), 30);
  EXPECT_EQ(film.code(0, 63, 47), 194);
}

TEST_F(AuthorFilm, CutsAnOddSizeOffBothAlike) {
  const AuthorSummary summary =
      package(colorTrack(65, 49),
              depthTrack("gray", [](int c, int r, int) { return static_cast<std::uint32_t>(c + r); }, 65, 49));
  EXPECT_EQ(summary.format.color_width, 64);
  EXPECT_EQ(summary.format.color_height, 48);
  EXPECT_EQ(summary.format.depth_width, 64);
  EXPECT_EQ(summary.format.depth_height, 48);
  ASSERT_EQ(summary.notes.size(), 2u);
  EXPECT_THAT(summary.notes[0], HasSubstr("1 column and 1 row of the colour, 1 and 1 of the depth"));
  const Film film = readFilm(folder_ / "out.mkv");
  EXPECT_EQ(film.code(0, 63, 47), 110);
}

TEST_F(AuthorFilm, CutsTheSameShareOffADepthOfAnotherSize) {
  // One of 65 columns is 2 of 130 and none of 30 (0.46); the height is even.
  const auto sizeFor = [&](int depth_width) {
    return package(colorTrack(65, 48), depthTrack(
                                           "gray", [](int, int, int) { return 9u; }, depth_width, 48))
        .format.depth_width;
  };
  EXPECT_EQ(sizeFor(130), 128);
  std::filesystem::remove(folder_ / "out.mkv");
  EXPECT_EQ(sizeFor(30), 30);
}

TEST_F(AuthorFilm, KeepsTheColoursPrimariesAndTransfer) {
  const auto code = [](int c, int, int) { return static_cast<std::uint32_t>(c); };
  ClipTrack color = colorTrack();
  color.codec = "libx264";
  color.primaries = 9, color.transfer = 14;
  package(color, depthTrack("gray", code));
  const Film wide = readFilm(folder_ / "out.mkv");
  EXPECT_EQ(wide.pairs.at(0).color.primaries, 9);
  EXPECT_EQ(wide.pairs.at(0).color.transfer, 14);

  makeClip(folder_ / "color.mkv", {{.pix_fmt = "bgr0"}});  // RGB becomes BT.709
  ASSERT_TRUE(make({.url = folder_ / "color.mkv", .depth_url = folder_ / "depth.mkv"}, "rgb.mkv").has_value());
  const Film rgb = readFilm(folder_ / "rgb.mkv");
  EXPECT_EQ(rgb.pairs.at(0).color.primaries, kBt709);
  EXPECT_EQ(rgb.pairs.at(0).color.transfer, kBt709);
}

TEST_F(AuthorFilm, TellsWhatItDoesNotKeep) {
  ClipTrack color = colorTrack(), third = colorTrack();
  color.codec = "libx264";
  color.options = {{"flags", "+ildct+ilme"}};
  color.primaries = 9, color.transfer = 16;
  // A quarter of the columns is outside the given codes.
  const ClipTrack depth =
      depthTrack("gray", [](int c, int r, int) { return c < 16 ? 255u : 50u + static_cast<unsigned>(r); });
  makeClip(folder_ / "film.mkv", {color, depth, third}, {}, {{}, {}});
  const auto summary = make({.url = folder_ / "film.mkv", .command_line = {{"codes", "10-110"}}});
  ASSERT_TRUE(summary.has_value());
  for (const char* line : {"1 more video track", "30 pictures were interlaced", "the colour is HDR (PQ)",
                           "25 % of the depth was outside the codes 10 .. 110"}) {
    EXPECT_THAT(summary->notes, testing::Contains(HasSubstr(line)));
  }

  const auto all = make({.url = folder_ / "film.mkv", .command_line = {{"codes", "1-2"}}}, "clipped.mkv");
  ASSERT_TRUE(all.has_value());
  EXPECT_THAT(all->notes, testing::Contains(testing::StartsWith("100 % of the depth was outside the codes 1 .. 2")));

  color.options.clear();
  color.transfer = 14;
  makeClip(folder_ / "wide.mkv", {color, depth});
  const auto wide = make({.url = folder_ / "wide.mkv"}, "wide-out.mkv");
  ASSERT_TRUE(wide.has_value());
  EXPECT_THAT(wide->notes, testing::Contains(HasSubstr("wide primaries")));
  EXPECT_THAT(wide->notes, testing::Not(testing::Contains(HasSubstr("interlaced"))));
}

TEST_F(AuthorFilm, KeepsTheColour) {
  ClipTrack color = colorTrack();
  color.range = ColorRange::Full;
  color.sample_width = 4;
  color.sample_height = 3;
  color.sample = [](int component, int c, int r, int) {
    return component == 0 ? static_cast<std::uint32_t>(2 * c + r) : component == 1 ? 90u : 170u;
  };
  package(color, depthTrack("gray", [](int, int, int) { return 9u; }));
  const Film film = readFilm(folder_ / "out.mkv");
  const Frame& frame = film.pairs.at(4).color;
  EXPECT_EQ(frame.range, ColorRange::Full);
  EXPECT_NEAR(frame.sample_aspect, 4.0 / 3, 1e-3);
  for (const auto& [c, r] : {std::pair{5, 5}, {60, 40}, {30, 20}}) {
    EXPECT_NEAR(static_cast<double>(test::sampleAt(frame, 0, c, r)), 2 * c + r, 6);
    EXPECT_NEAR(static_cast<double>(test::sampleAt(frame, 1, c / 2, r / 2)), 90, 3);
    EXPECT_NEAR(static_cast<double>(test::sampleAt(frame, 2, c / 2, r / 2)), 170, 3);
  }
}

TEST_F(AuthorFilm, SampleIsAFilmLikeAnyOther) {
  const auto summary = authorSample({.cols = 160, .rows = 108, .frames = 40, .threads = 2},
                                    {.path = folder_ / "out.mp4", .depth = {.crf = 0}}, stop_, kNoReport);
  ASSERT_TRUE(summary.has_value());
  EXPECT_EQ(summary->totals.depth.frames, 40u);
  const Film film = readFilm(folder_ / "out.mp4");
  ASSERT_EQ(film.pairs.size(), 40u);
  EXPECT_EQ(film.info.calibration.origin, CalibrationOrigin::ContainerTags);
  // In a smooth area: the exact height, in codes.
  const double x = ((80 + 0.5) / 160 - 0.5) * 160, y = (0.5 - (54 + 0.5) / 108) * 108;
  EXPECT_NEAR(film.code(33, 80, 54), 255.0 / 40 * sampleSceneHeight(x, y, 33 / 30.0), 0.51);
}

TEST_F(AuthorFilm, CutsADepthForFlatChromaToAnEvenSize) {
  makeClip(folder_ / "color.mkv", {colorTrack(64, 48)});
  makeClip(folder_ / "depth.mkv",
           {depthTrack("gray", [](int c, int r, int) { return static_cast<std::uint32_t>(c + r); }, 33, 25)});
  // One of 33 columns is 2 of 64 (1.03 of 33); one of 25 rows is 2 of 48 (1.04 of 25).
  const auto summary =
      authorFilm({.url = folder_ / "color.mkv", .depth_url = folder_ / "depth.mkv"}, kFfmpeg,
                 {.path = folder_ / "out.mkv", .depth = {.flat_chroma = true, .crf = 0}}, stop_, kNoReport);
  ASSERT_TRUE(summary.has_value()) << summary.error().error.message;
  EXPECT_EQ(summary->format.color_width, 62);
  EXPECT_EQ(summary->format.color_height, 46);
  EXPECT_EQ(summary->format.depth_width, 32);
  EXPECT_EQ(summary->format.depth_height, 24);
  EXPECT_EQ(readFilm(folder_ / "out.mkv").code(0, 31, 23), 54);
}

TEST_F(AuthorFilm, TakesADepthThatIsAllHoles) {
  SourceOptions source;
  source.command_line = {{"invalid", "7"}};
  const AuthorSummary summary = package(colorTrack(), depthTrack("gray", [](int, int, int) { return 7u; }), source);
  EXPECT_EQ(summary.codes.holes, summary.codes.samples);
  EXPECT_THAT(toText("out.mkv", summary), HasSubstr("none, the whole depth is holes"));
  EXPECT_EQ(readFilm(folder_ / "out.mkv").info.calibration.calibration.invalid, CodeSet(0));
}

}  // namespace
}  // namespace relievo
