// SPDX-License-Identifier: Apache-2.0
// relievo-author from end to end: colour and depth become one film, sample by sample and time by time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "app/author/author.h"
#include "app/scene/height_field.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/scenario/author/author_film.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/mkv_patch.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(AuthorFilm, BringsTwoFilesTogetherWithTheirCodesAndTimes) {
  const auto code = [](int c, int r, int k) { return static_cast<std::uint32_t>((c * 3 + r * 5 + k * 7) & 255); };
  const AuthorSummary summary = package(colorTrack(), depthTrack("gray", code));
  EXPECT_EQ(summary.totals.color.frames, 30u);
  EXPECT_EQ(summary.totals.depth.frames, 30u);
  EXPECT_EQ(summary.codes.samples, 30u * 64 * 48);
  EXPECT_TRUE(summary.notes.empty());

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
  ASSERT_EQ(summary.notes.size(), 1u);
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

TEST_F(AuthorFilm, WritesADepthOfALowerRateOnceAPicture) {
  ClipTrack depth = depthTrack("gray", [](int, int, int k) { return static_cast<std::uint32_t>(10 * k); });
  depth.fps_num = 15;
  depth.frames = 15;
  const AuthorSummary summary = package(colorTrack(), depth);
  EXPECT_EQ(summary.totals.color.frames, 30u);
  EXPECT_EQ(summary.totals.depth.frames, 15u);
  const Film film = readFilm(folder_ / "out.mkv");
  ASSERT_EQ(film.pairs.size(), 30u);
  for (std::size_t k = 0; k < 30; ++k) {
    EXPECT_EQ(film.code(k, 3, 3), static_cast<int>(10 * (k / 2))) << k;
    EXPECT_NEAR(toSeconds(film.pairs[k].depth.pts), static_cast<double>(k / 2) / 15, 6e-4) << k;
  }
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

// Every row of the odd field shows the square further right.
TEST_F(AuthorFilm, AnInterlacedFilmHasNoCombs) {
  ClipTrack color = colorTrack();
  color.codec = "libx264";
  color.options = {{"flags", "+ildct+ilme"}, {"crf", "1"}};
  color.sample = [](int component, int c, int r, int) {
    const int left = r % 2 == 0 ? 16 : 32;
    return component > 0 ? 128u : c >= left && c < left + 16 ? 200u : 40u;
  };
  makeClip(folder_ / "film.mkv",
           {color, depthTrack("gray", [](int, int r, int) { return 50u + static_cast<unsigned>(r); })});
  ASSERT_TRUE(make({.url = folder_ / "film.mkv"}).has_value());
  const Film film = readFilm(folder_ / "out.mkv");
  for (int r = 4; r < 44; ++r) {
    const auto left = static_cast<int>(test::sampleAt(film.pairs.at(3).color, 0, 24, r));
    const auto right = static_cast<int>(test::sampleAt(film.pairs.at(3).color, 0, 40, r));
    EXPECT_NEAR(left + right, 240, 30) << r << ": one square";
    EXPECT_NEAR(left, test::sampleAt(film.pairs.at(3).color, 0, 24, 20), 30) << r << ": of one field";
  }
  EXPECT_FALSE(film.pairs.at(3).color.interlaced);
}

TEST_F(AuthorFilm, TimesThatJumpBackAreMended) {
  ClipTrack color = colorTrack(64, 48, 5, 75);
  color.codec = "libx264";
  ClipTrack depth = depthTrack("gray", [](int, int r, int) { return 50u + static_cast<unsigned>(r); });
  depth.fps_num = 5, depth.frames = 75;
  makeClip(folder_ / "film.mkv", {color, depth});
  ASSERT_GT(test::moveClustersBack(folder_ / "film.mkv", 6000, 4000), 0);
  const auto summary = make({.url = folder_ / "film.mkv"});
  ASSERT_TRUE(summary.has_value()) << summary.error().thing << summary.error().error.message;
  EXPECT_EQ(summary->totals.color.frames, 75u);
  EXPECT_NEAR(toSeconds(summary->totals.color.last - summary->totals.color.first), 14.8, 0.3);
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

TEST_F(AuthorFilm, ThinsADepthOfAHigherRateAndSaysSo) {
  ClipTrack depth = depthTrack("gray", [](int, int, int k) { return static_cast<std::uint32_t>(4 * k); });
  depth.fps_num = 60;
  depth.frames = 60;
  const AuthorSummary summary = package(colorTrack(), depth);
  EXPECT_EQ(summary.totals.depth.frames, 30u);
  ASSERT_FALSE(summary.notes.empty());
  EXPECT_THAT(summary.notes, testing::Contains(HasSubstr("depth pictures matched no colour picture")));
  const Film film = readFilm(folder_ / "out.mkv");
  EXPECT_EQ(film.code(7, 3, 3), 56);  // the depth of the same time: its picture 14
}

TEST_F(AuthorFilm, LetsTheDepthEndEarlier) {
  ClipTrack depth = depthTrack("gray", [](int, int, int) { return 50u; });
  depth.frames = 10;
  const AuthorSummary summary = package(colorTrack(), depth);
  EXPECT_EQ(summary.totals.color.frames, 30u);
  EXPECT_EQ(summary.totals.depth.frames, 10u);
  EXPECT_THAT(summary.notes,
              ElementsAre(HasSubstr("20 colour pictures have no depth"), HasSubstr("of the depth is one code")));
  const Film film = readFilm(folder_ / "out.mkv");
  EXPECT_FALSE(film.pairs[9].depth.empty());
  EXPECT_TRUE(film.pairs[12].depth.empty());
}

TEST_F(AuthorFilm, CountsPicturesWithoutDepthAndThoseWithTheOneBefore) {
  ClipTrack depth = depthTrack("gray", [](int, int, int) { return 50u; });
  depth.time = [](int k) -> std::optional<Duration> {
    if (k < 3 || (k >= 12 && k < 16)) return std::nullopt;  // begins late, and four are missing in the middle
    return Duration(k * 1'000'000'000LL / 30);
  };
  makeClip(folder_ / "film.mkv", {colorTrack(), depth});
  const auto summary = make({.url = folder_ / "film.mkv"});
  ASSERT_TRUE(summary.has_value());
  EXPECT_THAT(summary->notes, ElementsAre(HasSubstr("3 colour pictures have no depth"),
                                          HasSubstr("4 colour pictures lacked their depth picture"),
                                          HasSubstr("of the depth is one code")));
}

TEST_F(AuthorFilm, SaysThatASourceBreaksOff) {
  makeClip(folder_ / "film.mkv", {colorTrack(64, 48, 30, 90), depthTrack("gray", [](int, int, int) { return 9u; })});
  std::filesystem::resize_file(folder_ / "film.mkv", std::filesystem::file_size(folder_ / "film.mkv") / 2);
  const auto summary = make({.url = folder_ / "film.mkv"});
  ASSERT_TRUE(summary.has_value());
  ASSERT_FALSE(summary->notes.empty());
  EXPECT_THAT(summary->notes[0], HasSubstr("film.mkv ends "));
}

TEST_F(AuthorFilm, PutsKeyFramesAtTheSamePlacesOfBothTracks) {
  ClipTrack depth = depthTrack(
      "gray", [](int c, int r, int k) { return static_cast<std::uint32_t>((c * 7 + r * 3 + k * 11) & 255); });
  depth.frames = 100;
  package(colorTrack(64, 48, 30, 100), depth);
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder_ / "out.mkv").has_value());
  std::map<int, std::vector<int>> keys;
  while (auto packet = source->read().value()) {
    if (packet->keyframe) keys[packet->stream].push_back(static_cast<int>(std::lround(toSeconds(*packet->pts) * 30)));
  }
  EXPECT_THAT(keys[0], ElementsAre(0, 30, 60, 90));
  EXPECT_THAT(keys[1], ElementsAre(0, 30, 60, 90));
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

TEST_F(AuthorFilm, LeavesNothingWhenItIsInterrupted) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int) { return 9u; })});
  std::uint64_t reached = 0;
  const auto stopAtFive = [&](std::uint64_t done, std::optional<std::uint64_t> total) {
    EXPECT_EQ(total, std::optional<std::uint64_t>(30));
    EXPECT_LE(made().size(), 1u);  // the temporary file, if it has a name
    reached = done;
    if (done == 5) stop_ = true;
  };
  const auto summary = authorFilm({.url = folder_ / "color.mkv", .depth_url = folder_ / "depth.mkv"}, kBackends,
                                  {.path = folder_ / "out.mkv"}, stop_, stopAtFive);
  ASSERT_FALSE(summary.has_value());
  EXPECT_EQ(summary.error().error.code, ErrorCode::Cancelled);
  EXPECT_EQ(reached, 5u);
  EXPECT_TRUE(made().empty());
}

TEST_F(AuthorFilm, LeavesNothingWhenTheSampleIsInterrupted) {
  const auto stopAtTwo = [&](std::uint64_t done, std::optional<std::uint64_t>) { stop_ = done == 2; };
  const auto summary = authorSample({.cols = 64, .rows = 48}, {.path = folder_ / "out.mkv"}, stop_, stopAtTwo);
  ASSERT_FALSE(summary.has_value());
  EXPECT_EQ(summary.error().error.code, ErrorCode::Cancelled);
  EXPECT_TRUE(made().empty());
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

TEST_F(AuthorFilm, PutsKeyFramesAtCuts) {
  // From a slope to its mirror image between 40 and 41; a second has its own at 30, and 71 is a second from the cut.
  ClipTrack depth =
      depthTrack("gray", [](int c, int, int k) { return static_cast<std::uint32_t>(k <= 40 ? 4 * c : 255 - 4 * c); });
  depth.frames = 80;
  package(colorTrack(64, 48, 30, 80), depth);
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder_ / "out.mkv").has_value());
  std::map<int, std::vector<int>> keys;
  while (auto packet = source->read().value()) {
    if (packet->keyframe) keys[packet->stream].push_back(static_cast<int>(std::lround(toSeconds(*packet->pts) * 30)));
  }
  EXPECT_THAT(keys[0], ElementsAre(0, 30, 41, 71));
  EXPECT_THAT(keys[1], ElementsAre(0, 30, 41, 71));
}

TEST_F(AuthorFilm, CutsADepthForFlatChromaToAnEvenSize) {
  makeClip(folder_ / "color.mkv", {colorTrack(64, 48)});
  makeClip(folder_ / "depth.mkv",
           {depthTrack("gray", [](int c, int r, int) { return static_cast<std::uint32_t>(c + r); }, 33, 25)});
  // One of 33 columns is 2 of 64 (1.03 of 33); one of 25 rows is 2 of 48 (1.04 of 25).
  const auto summary =
      authorFilm({.url = folder_ / "color.mkv", .depth_url = folder_ / "depth.mkv"}, kBackends,
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
