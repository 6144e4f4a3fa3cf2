// SPDX-License-Identifier: Apache-2.0
// Recordings as other programs leave them, opened without any option: shape, scale, polarity, holes, and who said so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "app/media/pair_reader.h"
#include "app/scene/height_field.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"
#include "tests/support/film/recorded_scene.h"
#include "tests/unit/media/recordings.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::kSceneCols;
using test::kSceneRows;
using test::makeClip;
using test::TemporaryFolder;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

void expectSame(const Seen& seen, const Distances& true_ones, double step_mm, const std::string& name) {
  ASSERT_EQ(seen.failure, "") << name;
  ASSERT_TRUE(seen.info.has_depth) << name;
  const Distances found = measure(seen);
  EXPECT_NEAR(found.median, true_ones.median, std::max(0.005 * true_ones.median, step_mm)) << name;
  EXPECT_NEAR(found.holes, true_ones.holes, 0.005) << name;
  // The ball is nearer than the wall.
  const HeightField field = HeightField::make(seen.depth, seen.info.calibration.calibration, kVolume).value();
  const auto mean = [&](int column, int row) {
    double sum = 0, count = 0;
    for (int i = 0; i < 100; ++i) {
      const double height = field.heightMm(column + i % 10, row + i / 10);
      if (std::isnan(height)) continue;
      sum += height;
      ++count;
    }
    return sum / count;
  };
  EXPECT_GT(mean(field.cols() / 2 - 5, field.rows() / 2 - 5), mean(field.cols() - 12, 2) + 1) << name;
}

// One recording: its depth pictures' path below the folder, and its codes.
struct Recording {
  const char* depth;
  Code code;
  const char* kind;
  double scale = 1, step_mm = 1;
};

TEST(Recordings, PicturesOfSixteenBitsAreReadAsTheyCome) {
  const auto or_hole = [](std::uint32_t hole, const std::function<double(double)>& code) {
    return [=](double mm, int, int) { return mm == 0 ? hole : rounded(code(mm)); };
  };
  const auto mm = [](double z) { return z; };
  const auto kinect = [](double z) { return 1092.5 - 351300 / z; };
  const Recording recordings[] = {
      {"a/depth/%04d.png", or_hole(0, mm), "mm"},
      {"b/depth/%04d.png", or_hole(65535, mm), "mm"},
      {"c/depth/%04d.png", [](double z, int c, int) { return z == 0 ? c % 2 * 65535u : rounded(z); }, "mm"},
      {"seq-01/frame-%06d.depth.png", or_hole(65535, mm), "mm"},
      {"rgbd_dataset_freiburg1_desk/depth/%04d.png", or_hole(0, [](double z) { return 5 * z; }), "tum", 1, 0.2},
      {"d/depth/%04d.png", or_hole(0, [](double z) { return 15 * z; }), "tum", 3, 0.2},
      {"i/depth/%04d.png", or_hole(0, [](double z) { return 10 * std::round(z); }), "ycb"},
      {"living_room_traj0/depth/%d.png", or_hole(0, [](double z) { return 5 * z; }), "icl", 1, 0.2},
      {"proj_depth/image_02/%010d.png", or_hole(0, [](double z) { return 256 * 8e-3 * z; }), "kitti", 8, 4},
      {"sunrgbd/depth/%04d.png", or_hole(0, [](double z) { return 8 * std::round(z); }), "sun"},
      {"e/depth/%04d.png",
       [](double z, int, int) {
         const std::uint32_t code = rounded(5.5 * z);  // the farthest beyond 8.19 m
         return (code << 3 | code >> 13) & 0xffff;
       },
       "sun", 5.5},
      {"f/depth/%04d.png", or_hole(2047, kinect), "kinect-raw", 1, 8},
      {"g/depth/%04d.png",
       [=](double z, int, int) {
         const std::uint32_t code = z == 0 ? 2047 : rounded(kinect(z));
         return code >> 8 | (code & 0xff) << 8;
       },
       "nyu-raw", 1, 8},
      {"h/depth/%04d.png", [](double z, int, int) { return rounded(z) >> 8 | (rounded(z) & 0xff) << 8; }, "mm-swapped"},
      {"kitti/disp_occ_0/%06d_10.png", or_hole(0, [](double z) { return 256 * 721 * 540 / (8 * z); }),
       "kitti-disparity", 8, 8},
  };
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  for (const Recording& each : recordings) {
    const std::string path = folder / each.depth;
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    makeClip(path, {coded(each.code)});
    const Seen seen = open({.url = folder / "color.mkv", .depth_url = path});
    expectSame(seen, truth(each.scale), each.step_mm, each.depth);
    EXPECT_THAT(seen.info.reading.doubts, IsEmpty()) << each.depth;
    // The depth alone, and with its kind stated, is read in the same way.
    const Seen alone = open({.url = path});
    expectSame(alone, truth(each.scale), each.step_mm, each.depth);
    EXPECT_EQ(alone.info.packing, Packing::DepthAlone) << each.depth;
    EXPECT_THAT(alone.info.reading.doubts, IsEmpty()) << each.depth;
    const Seen stated = open({.url = folder / "color.mkv", .depth_url = path, .as = findKind(each.kind)});
    expectSame(stated, truth(each.scale), each.step_mm, each.kind);
  }
}

// Five sixths of the points of a laser scanner are missing, between the others.
TEST(Recordings, PointsOfALaserScannerAreDistancesWithHolesBetween) {
  const auto is_seen = [](int c, int r) { return (c * 7 + r * 13) % 6 == 0; };
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  makeClip(folder / "%04d.png",
           {coded([=](double mm, int c, int r) { return is_seen(c, r) ? rounded(256 * 8e-3 * mm) : 0; })});
  const Seen seen = open({.url = folder / "color.mkv", .depth_url = folder / "%04d.png"});
  expectSame(seen, truth(8, is_seen), 4, "sparse");
  EXPECT_THAT(seen.info.reading.offers, Contains(HasSubstr("--as mm")));
}

TEST(Recordings, AFileBesideThePicturesGivesTheirScale) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  std::filesystem::create_directories(folder / "000001/depth");
  std::ofstream(folder / "000001/scene_camera.json") << R"({"0": {"cam_K": [1, 0, 0], "depth_scale": 0.1}})";
  makeClip(folder / "000001/depth/%06d.png", {coded([](double mm, int, int) { return rounded(10 * mm); })});
  const Seen seen = open({.url = folder / "color.mkv", .depth_url = folder / "000001/depth/%06d.png"});
  expectSame(seen, truth(), 0.1, "BOP");
  EXPECT_THAT(seen.info.reading.why, Contains(HasSubstr("scene_camera.json")));
  // A damaged file is ignored, and the codes are read by their looks.
  std::ofstream(folder / "000001/scene_camera.json") << R"({"0": {"cam_K": [1, 0, 0], "depth_sc)";
  expectSame(open({.url = folder / "color.mkv", .depth_url = folder / "000001/depth/%06d.png"}), truth(2), 0.2, "none");
}

TEST(Recordings, TheFirstPictureThatShowsSomethingIsLookedAt) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo(6)});
  ClipTrack late = coded([](double mm, int, int) { return rounded(mm); }, 6);
  late.sample = [](int, int c, int r, int k) { return k < 3 ? 0 : rounded(distanceMm(c, r)); };
  makeClip(folder / "%04d.png", {late});
  const Seen seen = open({.url = folder / "color.mkv", .depth_url = folder / "%04d.png"});
  ASSERT_EQ(seen.failure, "");
  EXPECT_EQ(seen.info.calibration.calibration.unit_mm, 1.0);
  EXPECT_THAT(seen.info.reading.doubts, IsEmpty());
}

TEST(Recordings, ExchangedInputsAndOtherShapesAreTold) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  makeClip(folder / "depth.mkv", {ClipTrack{.pix_fmt = "gray", .width = 160, .height = 108, .frames = 2}});
  makeClip(folder / "wide.mkv", {ClipTrack{.pix_fmt = "gray", .width = 192, .height = 108, .frames = 2}});
  EXPECT_THAT(open({.url = folder / "depth.mkv", .depth_url = folder / "color.mkv"}).info.reading.doubts,
              Contains(HasSubstr("exchanged")));
  EXPECT_THAT(open({.url = folder / "color.mkv", .depth_url = folder / "wide.mkv"}).info.reading.doubts,
              Contains(HasSubstr("in the colour's shape")));
  EXPECT_THAT(open({.url = folder / "color.mkv", .depth_url = folder / "depth.mkv"}).info.reading.doubts,
              testing::ElementsAre(HasSubstr("nothing says which end")));
}

// RealSense's colouring "Cold", by distance: neither a hue nor a map whose codes are known.
TEST(Recordings, ColoursOfAnUnknownMapAreDoubtedWithoutAnOptionThatDoesNotHelp) {
  constexpr double kCold[][3] = {{230, 247, 255}, {0, 92, 230}, {0, 179, 179}, {0, 51, 153}, {0, 5, 15}};
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  ClipTrack cold = photo();
  cold.sample = [&](int k, int c, int r, int) {
    const double place = std::clamp((distanceMm(c, r) - 500) / 4000, 0.0, 0.999) * 4;
    const auto low = static_cast<std::size_t>(place);
    std::array<double, 3> color{};
    for (std::size_t i = 0; i < 3; ++i)
      color[i] = std::lerp(kCold[low][i], kCold[low + 1][i], place - std::floor(place)) / 255;
    return yuvCode(k, color);
  };
  makeClip(folder / "depth.mkv", {cold});
  const Seen seen = open({.url = folder / "color.mkv", .depth_url = folder / "depth.mkv"});
  EXPECT_THAT(seen.info.reading.doubts, Contains(HasSubstr("of no known map")));
  EXPECT_THAT(seen.info.reading.doubts, testing::Not(Contains(HasSubstr("--depth-code hue"))));
}

TEST(Recordings, MillimetresThatWereSaidToBeShadesAreDoubted) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  makeClip(folder / "%04d.png", {coded([](double mm, int, int) { return rounded(mm); })});
  const Seen seen = open({.url = folder / "color.mkv",
                          .depth_url = folder / "%04d.png",
                          .command_line = {{"polarity", "near-high"}, {"invalid", "0"}}});
  EXPECT_THAT(seen.info.reading.doubts, Contains(HasSubstr("--as mm")));
}

TEST(Recordings, EveryPartSaysWhoSaidIt) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  makeClip(folder / "%04d.png", {coded([](double mm, int, int) { return rounded(mm); })});
  const Seen seen = open({.url = folder / "color.mkv",
                          .depth_url = folder / "%04d.png",
                          .as = findKind("tum"),
                          .command_line = {{"near", "200"}, {"far", "500"}}});
  const auto lines = partLines(seen.info.reading);
  for (const char* line : {"packing=tracks: command line, said", "code=luma: default, assumed",
                           "kind=distances, 5000 codes a metre: --as, said", "unit=0.2: --as, said",
                           "near=200: command line, said", "bits=16: stream signalling, said"}) {
    EXPECT_THAT(lines, Contains(line));
  }
  // Without --as, the first picture shows the unit.
  const Seen shown = open({.url = folder / "color.mkv", .depth_url = folder / "%04d.png"});
  EXPECT_THAT(partLines(shown.info.reading), Contains("unit=1: first picture, likely"));
}

// Three pictures in a row or four in a square: one of the halves is both colour and depth.
TEST(Recordings, AThirdPictureIsTold) {
  const TemporaryFolder folder;
  const auto gray = [](int c, int r) {
    const double shade = 0.2 + 0.6 * r / kSceneRows + 0.1 * c / kSceneCols;
    return std::array{shade, shade, shade};
  };
  const auto expect = [&](const char* name, bool depth_first, const auto& is_colored, bool told) {
    const Half colored{[&](int c, int r) { return is_colored(c, r) ? photoOf(c, r) : gray(c, r); }}, depth{gray};
    makeHalves(folder / name, true, depth_first ? depth : colored, depth_first ? colored : depth);
    const FilmInfo info = open({.url = folder / name}).info;
    EXPECT_EQ(info.packing, depth_first ? Packing::SideBySideDepthFirst : Packing::SideBySide) << name;
    EXPECT_EQ(testing::Matches(Contains(HasSubstr("three pictures")))(info.notes), told) << name;
  };
  expect("pair.mp4", false, [](int, int) { return true; }, false);
  expect("row.mp4", false, [](int c, int) { return 3 * c < 2 * kSceneCols; }, true);
  expect("depth-first.mp4", true, [](int c, int) { return 3 * c > kSceneCols; }, true);
  expect("square.mp4", false, [](int, int r) { return 2 * r < kSceneRows; }, true);
}

// Its colour is the depth as gray; its maker has told whether the two are alike otherwise.
TEST(Recordings, AnAuthorsFilmOfDepthAloneIsNotDoubted) {
  const TemporaryFolder folder;
  ClipTrack gray{.pix_fmt = "gray", .width = kSceneCols, .height = kSceneRows, .frames = 2};
  gray.sample = [](int, int c, int r, int) { return yuvCode(0, photoOf(c, r)); };
  ClipTrack depth = gray;
  depth.tags = {{"title", "depth"}, {"DEPTH_POLARITY", "near-high"}};
  makeClip(folder / "copy.mkv", {gray, depth});
  depth.tags["DEPTH_READ_AS"] = "depth brightness";
  makeClip(folder / "author.mkv", {gray, depth});
  EXPECT_THAT(open({.url = folder / "copy.mkv"}).info.reading.doubts, Contains(HasSubstr("the same picture")));
  EXPECT_THAT(open({.url = folder / "author.mkv"}).info.reading.doubts, Not(Contains(HasSubstr("the same picture"))));
}

// The tags of a film do not state what its author only assumed.
TEST(Recordings, AGuessStaysOneInTheFilmsTags) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  makeClip(folder / "%04d.png", {coded([](double mm, int, int) { return rounded(mm); })});
  ClipTrack gray{.pix_fmt = "gray", .width = kSceneCols, .height = kSceneRows, .frames = 2};
  makeClip(folder / "gray.mkv", {gray});
  const auto tagsOf = [&](const std::string& depth, const CalibrationSettings& said) {
    return certaintyTags(
        open({.url = folder / "color.mkv", .depth_url = folder / depth, .command_line = said}).info.reading);
  };
  using Tags = std::map<std::string, std::string>;
  EXPECT_EQ(tagsOf("%04d.png", {}), (Tags{{"DEPTH_LIKELY", "law,polarity,near,far"}}));
  EXPECT_EQ(tagsOf("%04d.png", {{"unit", "1"}, {"near", "500"}, {"far", "3000"}}), Tags{});
  EXPECT_EQ(tagsOf("gray.mkv", {}), (Tags{{"DEPTH_ASSUMED", "law,polarity,near,far"}}));
  EXPECT_EQ(tagsOf("gray.mkv", {{"polarity", "near-low"}}), (Tags{{"DEPTH_ASSUMED", "law,near,far"}}));

  Tags tags{{"DEPTH_UNIT", "none"},
            {"DEPTH_POLARITY", "near-high"},
            {"DEPTH_LAW", "inverse"},
            {"DEPTH_NEAR", "400"},
            {"DEPTH_FAR", "900"}};
  makeClip(folder / "said.mkv", {gray}, tags);
  tags.insert({{"DEPTH_ASSUMED", "polarity,near,far"}, {"DEPTH_LIKELY", "law"}});
  makeClip(folder / "guessed.mkv", {gray}, tags);
  const auto readingOf = [&](const char* depth) {
    return open({.url = folder / "color.mkv", .depth_url = folder / depth}).info;
  };
  const FilmInfo said = readingOf("said.mkv"), guessed = readingOf("guessed.mkv");
  EXPECT_THAT(partLines(said.reading), Contains("near=400: container tags, said"));
  EXPECT_THAT(partLines(guessed.reading), Contains("near=400: container tags, assumed by its maker"));
  EXPECT_THAT(partLines(guessed.reading), Contains("law=inverse: container tags, thought likely by its maker"));
  EXPECT_EQ(guessed.calibration.calibration.near_mm, 400);
  EXPECT_THAT(plainLine(said.reading, said.calibration.calibration), HasSubstr("0.40 to 0.90 m (container tags)"));
  EXPECT_EQ(plainLine(guessed.reading, guessed.calibration.calibration),
            "depth brightness, near bright (container tags, assumed by its maker)");
  EXPECT_THAT(said.reading.offers, IsEmpty());
  EXPECT_THAT(guessed.reading.doubts, Contains(HasSubstr("polarity=near-low")));
}

}  // namespace
}  // namespace relievo
