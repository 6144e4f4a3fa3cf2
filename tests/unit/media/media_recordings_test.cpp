// SPDX-License-Identifier: Apache-2.0
// Recordings as other programs leave them: opened without any option, the reader finds shape, scale, polarity and
// holes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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

namespace relievo {
namespace {

using test::ClipTrack;
using test::distanceMm;
using test::hueColor;
using test::kSceneCols;
using test::kSceneRows;
using test::makeClip;
using test::photoOf;
using test::TemporaryFolder;
using test::yuvCode;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr DisplayVolume kVolume{160, 108, 40};
const PairReader::Backends kFfmpeg{[](const std::string&) { return makeFfmpegSource(); },
                                   [](const StreamInfo&) { return makeFfmpegDecoder(); }};

ClipTrack photo(int frames = 2) {
  ClipTrack track{.pix_fmt = "yuv444p", .width = kSceneCols, .height = kSceneRows, .frames = frames};
  track.sample = [](int k, int c, int r, int) { return yuvCode(k, photoOf(c, r)); };
  return track;
}

// Spots of 2 pixels, as bright as a number without order says (Knuth's multiplicative hash): no half looks like the
// other, while the rows of `photo` come again.
ClipTrack spots() {
  ClipTrack track{.pix_fmt = "yuv444p", .width = kSceneCols, .height = kSceneRows, .frames = 2};
  track.sample = [](int k, int c, int r, int) {
    const auto spot = static_cast<std::uint32_t>(c / 2 + 100 * (r / 2));
    return k > 0 ? 128u : 30 + (spot * spot * 2654435761u >> 16) % 190;
  };
  return track;
}

// Sixteen bits of gray in numbered PNG pictures: code(mm), where mm is 0 for a hole.
using Code = std::function<std::uint32_t(double mm, int c, int r)>;
ClipTrack coded(const Code& code, int frames = 2) {
  ClipTrack track{.codec = "png", .pix_fmt = "gray16be", .width = kSceneCols, .height = kSceneRows, .frames = frames};
  track.sample = [code](int, int c, int r, int) { return code(distanceMm(c, r), c, r); };
  return track;
}

std::uint32_t rounded(double x) {
  return static_cast<std::uint32_t>(std::lround(x));
}

struct Seen {
  FilmInfo info;
  Frame depth;
  std::string failure;
};
Seen open(const SourceOptions& options) {
  PairReader reader(kFfmpeg);
  if (const auto opened = reader.open(options); !opened) return {.failure = opened.error().message};
  auto pair = reader.next();
  if (!pair || !*pair) return {.failure = "no pair"};
  return {reader.info(), (*pair)->depth, ""};
}

// The distances of the samples that are no holes, by the definition in app/scene/depth_calibration.h, and the holes'
// share.
struct Distances {
  double median = 0, holes = 0;
};
Distances measure(const Seen& seen) {
  const DepthCalibration& c = seen.info.calibration.calibration;
  const HeightField field = HeightField::make(seen.depth, c, kVolume).value();
  std::vector<double> mm;
  for (int r = 0; r < field.rows(); ++r) {
    for (int x = 0; x < field.cols(); ++x) {
      const double height = field.heightMm(x, r);
      if (!std::isnan(height)) mm.push_back(c.far_mm - height / kVolume.depth_mm * (c.far_mm - c.near_mm));
    }
  }
  const double all = static_cast<double>(field.rows()) * field.cols();
  std::nth_element(mm.begin(), mm.begin() + static_cast<std::ptrdiff_t>(mm.size() / 2), mm.end());
  return {mm.empty() ? 0 : mm[mm.size() / 2], 1 - static_cast<double>(mm.size()) / all};
}

// The same of the scene itself, of the samples that `is_seen` leaves.
Distances truth(double scale = 1, const std::function<bool(int, int)>& is_seen = {}) {
  std::vector<double> mm;
  for (int r = 0; r < kSceneRows; ++r) {
    for (int c = 0; c < kSceneCols; ++c) {
      if (distanceMm(c, r) > 0 && (!is_seen || is_seen(c, r))) mm.push_back(scale * distanceMm(c, r));
    }
  }
  std::nth_element(mm.begin(), mm.begin() + static_cast<std::ptrdiff_t>(mm.size() / 2), mm.end());
  return {mm[mm.size() / 2], 1 - static_cast<double>(mm.size()) / (kSceneRows * kSceneCols)};
}

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
    // Alone, and stated, it is the same.
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
  // Damaged, it tells nothing, and the codes are read as they look.
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

// Two halves in one picture, in H.264 4:2:0.
struct Half {
  std::function<std::array<double, 3>(int c, int r)> color;
};
void makeHalves(const std::string& path, bool beside, const Half& first, const Half& second,
                const std::map<std::string, std::string>& tags = {}, int dark_frames = 0) {
  ClipTrack film{.codec = "libx264",
                 .pix_fmt = "yuv420p",
                 .width = beside ? 2 * kSceneCols : kSceneCols,
                 .height = beside ? kSceneRows : 2 * kSceneRows,
                 .frames = 2 + dark_frames,
                 .options = {{"crf", "8"}}};
  film.sample = [=](int k, int c, int r, int frame) {
    const int x = k == 0 ? c : 2 * c, y = k == 0 ? r : 2 * r;
    if (frame < dark_frames) return k == 0 ? 16u : 128u;
    const bool is_first = beside ? x < kSceneCols : y < kSceneRows;
    return yuvCode(k, (is_first ? first : second).color(x % kSceneCols, y % kSceneRows));
  };
  makeClip(path, {film}, tags);
}

const Half kPhoto{photoOf};

TEST(Recordings, Record3DIsToldByItsTagAndByItsLayout) {
  const Half hue{[](int c, int r) { return hueColor(distanceMm(c, r) / 3000); }};
  TemporaryFolder folder;
  const std::map<std::string, std::string> tags{
      {"comment", R"({"intrinsicMatrix":[400,0,0,0,400,0,80,54,1],"rangeOfEncodedDepth":[0,3]})"}};
  makeHalves(folder / "tagged.mp4", true, hue, kPhoto, tags);
  makeHalves(folder / "plain.mp4", true, hue, kPhoto);
  makeHalves(folder / "late.mp4", true, hue, kPhoto, {}, 3);
  for (const char* name : {"tagged.mp4", "plain.mp4"}) {
    const Seen seen = open({.url = folder / name});
    ASSERT_EQ(seen.failure, "");
    EXPECT_EQ(seen.info.packing, Packing::SideBySideDepthFirst);
    const Distances found = measure(seen);
    EXPECT_NEAR(found.median, truth().median, 0.01 * truth().median) << name;
    EXPECT_NEAR(found.holes, truth().holes, 0.02) << name;  // chroma mixes the columns at an edge
    EXPECT_THAT(plainLine(seen.info.reading, seen.info.calibration.calibration), HasSubstr("Record3D"));
  }
  EXPECT_EQ(open({.url = folder / "late.mp4"}).info.packing, Packing::SideBySideDepthFirst);
}

TEST(Recordings, DepthkitsFileGivesNearAndFar) {
  const Half hue{[](int c, int r) {
    const double mm = distanceMm(c, r);
    return mm == 0 ? std::array<double, 3>{0, 0, 0} : hueColor((mm - 900) / 1500);
  }};
  TemporaryFolder folder;
  makeHalves(folder / "clip.mp4", false, kPhoto, hue);
  std::ofstream(folder / "clip.txt")
      << R"({"format": "perpixel", "perspectives": [{"nearClip": 0.9, "farClip": 2.4}]})";
  const Seen seen = open({.url = folder / "clip.mp4"});
  ASSERT_EQ(seen.failure, "");
  EXPECT_EQ(seen.info.packing, Packing::TopBottom);
  EXPECT_NEAR(measure(seen).median, truth().median, 0.01 * truth().median);
  EXPECT_NEAR(measure(seen).holes, truth().holes, 0.02);
}

// Looking Glass: brightness in three components or in red alone.
TEST(Recordings, BrightnessBesideThePhotoIsFoundInGrayAndInRed) {
  const auto near_bright = [](int c, int r) {
    return distanceMm(c, r) == 0 ? 0.02 : std::clamp((2100 - distanceMm(c, r)) / 1000, 0.0, 1.0);
  };
  const Half gray{[=](int c, int r) { return std::array{near_bright(c, r), near_bright(c, r), near_bright(c, r)}; }};
  const Half red{[=](int c, int r) { return std::array{near_bright(c, r), 0.0, 0.0}; }};
  TemporaryFolder folder;
  makeHalves(folder / "gray.mp4", true, kPhoto, gray);
  makeHalves(folder / "red.mp4", true, kPhoto, red);
  for (const char* name : {"gray.mp4", "red.mp4"}) {
    const Seen seen = open({.url = folder / name});
    ASSERT_EQ(seen.failure, "");
    EXPECT_EQ(seen.info.packing, Packing::SideBySide) << name;
    EXPECT_EQ(seen.info.calibration.calibration.code, DepthCode::Luma) << name;
    const HeightField field = HeightField::make(seen.depth, seen.info.calibration.calibration, kVolume).value();
    EXPECT_NEAR(field.heightMm(kSceneCols / 2, kSceneRows / 2), 40 * 0.9999, 1.0) << name;
    EXPECT_NEAR(field.heightMm(kSceneCols - 4, 50), 40 * near_bright(kSceneCols - 4, 50), 1.0) << name;
    EXPECT_THAT(seen.info.reading.offers, Contains(HasSubstr("polarity=near-low"))) << name;
  }
}

// A white room with one blue thing is nearly as gray as its depth; where the halves meet, the picture breaks.
TEST(Recordings, TheDepthOfAPaleSceneIsFoundByTheBreakInTheMiddle) {
  const auto cup = [](int c, int r) { return c >= 60 && c < 100 && r >= 30 && r < 60; };
  const Half pale{[=](int c, int r) {
    const double wall = 0.7 + 0.1 * std::sin(c * 0.4);
    return cup(c, r) ? std::array{0.1, 0.15, 0.6} : std::array{wall, wall, wall};
  }};
  const Half depth{[=](int c, int r) {
    const double near_bright = cup(c, r) ? 0.6 : 0.15 + 0.001 * c;
    return std::array{near_bright, near_bright, near_bright};
  }};
  // A film whose left half is a gray wall, which goes on to the right of a coloured thing.
  const Half wall{[](int c, int) { return std::array{0.3 + 0.003 * c, 0.3 + 0.003 * c, 0.3 + 0.003 * c}; }};
  const Half goes_on{[=](int c, int r) {
    const double gray = 0.3 + 0.003 * (kSceneCols - c);
    return cup(c, r) ? std::array{0.1, 0.15, 0.6} : std::array{gray, gray, gray};
  }};
  TemporaryFolder folder;
  makeHalves(folder / "right.mp4", true, pale, depth);
  makeHalves(folder / "left.mp4", true, depth, pale);
  makeHalves(folder / "below.mp4", false, pale, depth);
  makeHalves(folder / "film.mp4", true, wall, goes_on);
  EXPECT_EQ(open({.url = folder / "right.mp4"}).info.packing, Packing::SideBySide);
  EXPECT_EQ(open({.url = folder / "left.mp4"}).info.packing, Packing::SideBySideDepthFirst);
  EXPECT_EQ(open({.url = folder / "below.mp4"}).info.packing, Packing::TopBottom);
  EXPECT_FALSE(open({.url = folder / "film.mp4"}).info.has_depth);
}

// Of a picture without a hole nothing tells whether high codes are near: both readings have their word.
TEST(Recordings, AFilmOfOneKeyFrameIsLookedAtFartherOnToo) {
  TemporaryFolder folder;
  ClipTrack depth{.width = kSceneCols, .height = kSceneRows, .frames = 48, .gop = 1000};
  // A wall that is seen by and by.
  depth.sample = [](int, int c, int r, int frame) {
    if (c < 4) return 0U;
    return c > 100 && frame > 30 ? 3600U + static_cast<unsigned>(r) : 1000 + static_cast<unsigned>(c + r);
  };
  depth.fps_num = 6;
  makeClip(folder / "a_depth.mkv", {depth});
  const Seen seen = open({.url = folder / "a_depth.mkv"});
  ASSERT_EQ(seen.failure, "");
  EXPECT_EQ(seen.info.calibration.calibration.unit_mm, 1.0);
  EXPECT_GE(seen.info.calibration.calibration.far_mm, 3600);
  EXPECT_LE(seen.info.calibration.calibration.near_mm, 1000);
}

TEST(Recordings, HeightsAreOfferedWhereNothingTellsThemFromDistances) {
  TemporaryFolder folder;
  makeClip(folder / "%04d.png", {coded([](double mm, int, int) { return 20000 - rounded(mm); })});
  const Seen far = open({.url = folder / "%04d.png"});
  EXPECT_THAT(far.info.reading.offers, Contains(HasSubstr("--as heights")));
  const Seen near = open({.url = folder / "%04d.png", .as = findKind("heights")});
  ASSERT_EQ(near.failure, "");
  const HeightField field = HeightField::make(near.depth, near.info.calibration.calibration, kVolume).value();
  EXPECT_GT(field.heightMm(80, 54), field.heightMm(150, 5) + 10);
  EXPECT_THAT(near.info.reading.doubts, IsEmpty());
  // A hole is what only a sensor has.
  makeClip(folder / "%04d.png", {coded([](double mm, int, int) { return rounded(mm); })});
  EXPECT_THAT(open({.url = folder / "%04d.png"}).info.reading.offers, ElementsAre(HasSubstr("unit=MM")));
  std::filesystem::create_directories(folder / "elevation");
  makeClip(folder / "elevation/%04d.png", {coded([](double mm, int, int) { return 20000 - rounded(mm); })});
  EXPECT_THAT(open({.url = folder / "elevation/%04d.png"}).info.calibration.calibration.polarity,
              DepthPolarity::NearIsHigh);
}

TEST(Recordings, HuesOfferTheirOtherEnd) {
  TemporaryFolder folder;
  const Half hue{[](int c, int r) { return hueColor(0.1 + 0.8 * (distanceMm(c, r) - 900) / 1500); }};
  makeHalves(folder / "a.mp4", true, kPhoto, hue);
  EXPECT_THAT(open({.url = folder / "a.mp4"}).info.reading.offers, Contains(HasSubstr("polarity=near-high")));
  EXPECT_THAT(open({.url = folder / "a.mp4", .command_line = {{"polarity", "near-low"}}}).info.reading.offers,
              IsEmpty());
}

// A blue ramp and a circle of hues may be a picture of anything, unless the name says depth.
TEST(Recordings, AColourMapWithoutColourIsFelt) {
  const auto ramp = [](double s) { return std::array{std::max(0.0, 2 * s - 1), s, 0.5 + 0.5 * s}; };
  const auto jet = [](double s) {
    const auto part = [&](double middle) { return std::clamp(1.5 - std::abs(4 * s - middle), 0.0, 1.0); };
    return std::array{part(3), part(2), part(1)};
  };
  TemporaryFolder folder;
  const auto make = [&](const char* name, auto color) {
    ClipTrack track{.codec = "png", .pix_fmt = "rgb24", .width = kSceneCols, .height = kSceneRows, .frames = 1};
    track.sample = [=](int k, int c, int r, int) {
      const double mm = distanceMm(c, r);
      return mm == 0 ? 0u : rounded(255 * color(1 - (mm - 1000) / 1100)[static_cast<std::size_t>(k)]);
    };
    makeClip(folder / name, {track});
    return open({.url = folder / name}).info;
  };
  const FilmInfo found = make("a.png", jet);
  EXPECT_EQ(found.packing, Packing::DepthAlone);
  EXPECT_EQ(found.calibration.calibration.code, DepthCode::Jet);
  EXPECT_THAT(found.reading.offers, Contains(HasSubstr("polarity=near-low")));
  EXPECT_FALSE(make("b.png", hueColor).has_depth);
  const FilmInfo told = open({.url = folder / "b.png", .packing = Packing::DepthAlone}).info;
  EXPECT_EQ(told.packing, Packing::DepthAlone) << "what is said wins over what the picture shows";
  EXPECT_EQ(told.calibration.calibration.code, DepthCode::Hue);
  EXPECT_EQ(told.depth_width, kSceneCols);
  EXPECT_TRUE(make("b_depth.png", hueColor).has_depth);
  EXPECT_FALSE(make("c.png", ramp).has_depth);
}

TEST(Recordings, GrayInAFileThatIsCalledDepthIsFelt) {
  TemporaryFolder folder;
  ClipTrack gray{.codec = "libx264", .pix_fmt = "yuv420p", .width = kSceneCols, .height = kSceneRows, .frames = 2};
  gray.sample = [](int k, int c, int r, int) { return k > 0 ? 128u : 16 + static_cast<std::uint32_t>(c + r / 2); };
  for (const char* name : {"clip_depth.mp4", "clip.mp4"}) {
    makeClip(folder / name, {gray});
    const Seen seen = open({.url = folder / name});
    ASSERT_EQ(seen.failure, "");
    EXPECT_EQ(seen.info.packing == Packing::DepthAlone, std::string(name) == "clip_depth.mp4");
  }
}

TEST(Recordings, DepthThatLiesBesideTheFilmIsTakenAndSaid) {
  TemporaryFolder folder;
  makeClip(folder / "clip.mkv", {photo()});
  ClipTrack depth = coded([](double mm, int, int) { return rounded(mm); });
  depth.codec = "ffv1";
  depth.pix_fmt = "gray16le";
  makeClip(folder / "clip-depth.mkv", {depth});
  const Seen seen = open({.url = folder / "clip.mkv"});
  EXPECT_TRUE(seen.info.has_depth);
  EXPECT_THAT(seen.info.notes, Contains(HasSubstr("clip-depth.mkv, which lies beside it")));
  EXPECT_THAT(open({.url = folder / "clip.mkv", .packing = Packing::SideBySide}).info.notes,
              testing::Not(Contains(HasSubstr("lies beside it"))));
  std::ofstream(folder / "clip-depth.mkv") << "no film";
  const Seen flat = open({.url = folder / "clip.mkv"});
  EXPECT_EQ(flat.failure, "");
  EXPECT_FALSE(flat.info.has_depth);
  EXPECT_THAT(flat.info.notes, Contains(HasSubstr("no depth that can be read")));
}

TEST(Recordings, TwoViewsAreToldAndNeverFelt) {
  const Half left{photoOf};
  const Half right{[](int c, int r) { return photoOf(c + 4 + (r > 50 ? 3 : 0), r); }};
  TemporaryFolder folder;
  makeHalves(folder / "sbs.mp4", true, left, right);
  makeHalves(folder / "tb.mp4", false, left, right);
  ClipTrack second = photo();
  second.sample = [](int k, int c, int r, int) { return yuvCode(k, photoOf(c + 5, r)); };
  makeClip(folder / "tracks.mkv", {photo(), second});
  for (const char* name : {"sbs.mp4", "tb.mp4", "tracks.mkv"}) {
    const Seen seen = open({.url = folder / name});
    ASSERT_EQ(seen.failure, "") << name;
    EXPECT_FALSE(seen.info.has_depth) << name;
    EXPECT_TRUE(seen.depth.empty()) << name;
    EXPECT_THAT(seen.info.reading.doubts, Contains(HasSubstr("two views"))) << name;
  }
  EXPECT_THAT(open({.url = folder / "sbs.mp4", .packing = Packing::SideBySide}).info.reading.doubts,
              Contains(HasSubstr("the same picture")));
}

// --depth-from stereo: the pairs keep both views, and whoever plays them makes the depth.
TEST(Recordings, DepthIsMadeOfTwoViewsOnlyWhereThereAreTwo) {
  const Half left{photoOf};
  const Half right{[](int c, int r) { return photoOf(c + 4 + (r > 50 ? 3 : 0), r); }};
  TemporaryFolder folder;
  makeHalves(folder / "views.mp4", true, left, right);
  makeClip(folder / "one.mkv", {spots()});
  const auto from = [&](const char* name, Packing packing = Packing::Auto) {
    return open({.url = folder / name, .packing = packing, .depth_from = DepthFrom::Views});
  };
  const Seen views = from("views.mp4", Packing::StereoSideBySide);
  EXPECT_TRUE(views.info.has_depth);
  EXPECT_TRUE(views.info.depth_from_views);
  EXPECT_EQ(views.info.calibration.calibration.bits, 16);
  EXPECT_THAT(views.info.reading.doubts, IsEmpty());
  const Seen one = from("one.mkv");
  EXPECT_FALSE(one.info.has_depth);
  EXPECT_THAT(one.info.reading.doubts, ElementsAre(HasSubstr("the film has one view")));
  ClipTrack depth = coded([](double mm, int, int) { return rounded(mm); });
  depth.codec = "ffv1";
  depth.pix_fmt = "gray16le";
  makeClip(folder / "both.mkv", {photo(), depth});
  const Seen both = from("both.mkv");
  EXPECT_TRUE(both.info.has_depth);
  EXPECT_FALSE(both.info.depth_from_views);
  EXPECT_THAT(both.info.reading.doubts, Contains(HasSubstr("the film has depth of its own")));
}

// What the user says of a film of one view cannot be: told in one line, and no depth is made of it.
TEST(Recordings, AFilmOfOneViewIsNotTakenForTwo) {
  TemporaryFolder folder;
  makeClip(folder / "one.mkv", {spots()});
  for (const Packing packing : {Packing::StereoSideBySide, Packing::StereoTopBottom}) {
    const Seen seen = open({.url = folder / "one.mkv", .packing = packing, .depth_from = DepthFrom::Views});
    EXPECT_FALSE(seen.info.has_depth);
    EXPECT_THAT(seen.info.reading.doubts, ElementsAre(HasSubstr("do not show one scene")));
  }
  const Half left{photoOf};
  const Half right{[](int c, int r) { return photoOf(c + 6, r); }};
  makeHalves(folder / "views.mp4", true, left, right);
  EXPECT_THAT(open({.url = folder / "views.mp4", .packing = Packing::StereoSideBySide}).info.reading.doubts, IsEmpty());
}

TEST(Recordings, EachEyeOfTwoViewsIsShownItsOwn) {
  const Half dark{[](int, int) { return std::array{0.2, 0.2, 0.2}; }},
      bright{[](int, int) { return std::array{0.8, 0.8, 0.8}; }};
  TemporaryFolder folder;
  makeHalves(folder / "sbs.mp4", true, dark, bright);
  makeHalves(folder / "tb.mp4", false, dark, bright);
  const test::OpenedFilm beside = test::openFilm({.url = folder / "sbs.mp4", .packing = Packing::StereoSideBySide});
  const test::OpenedFilm above = test::openFilm({.url = folder / "tb.mp4", .packing = Packing::StereoTopBottom});
  for (const test::OpenedFilm* film : {&beside, &above}) {
    EXPECT_FALSE(film->info.has_depth);
    ASSERT_FALSE(film->pair.right.empty());
    EXPECT_EQ(film->pair.color.width, kSceneCols);
    EXPECT_EQ(film->pair.right.height, kSceneRows);
    EXPECT_LT(test::sampleAt(film->pair.color, 0, 20, 20) + 50, test::sampleAt(film->pair.right, 0, 20, 20));
  }
  // 320 x 108 is wide enough for two whole views; 160 x 216 is two whole ones above each other.
  EXPECT_EQ(beside.pair.color.sample_aspect, 1);
  EXPECT_EQ(above.pair.color.sample_aspect, 1);
  ClipTrack squeezed{.codec = "libx264", .pix_fmt = "yuv420p", .width = 160, .height = 90, .frames = 2};
  makeClip(folder / "half.mp4", {squeezed});
  EXPECT_EQ(test::openFilm({.url = folder / "half.mp4", .packing = Packing::StereoSideBySide}).pair.color.sample_aspect,
            2);
  EXPECT_EQ(test::openFilm({.url = folder / "half.mp4", .packing = Packing::StereoTopBottom}).pair.color.sample_aspect,
            0.5);
}

TEST(Recordings, OrdinaryFilmsAreNeitherDepthNorViews) {
  const Half mirrored{[](int c, int r) { return photoOf(kSceneCols - 1 - c, r); }};
  const Half upside_down{[](int c, int r) { return photoOf(c, kSceneRows - 1 - r); }};
  const Half gray{[](int c, int r) {
    const double y = photoOf(c, r)[0];
    return std::array{y, y, y};
  }};
  const Half other_gray{[](int c, int r) {
    const double y = photoOf(c + 300, r + 500)[1];
    return std::array{y, y, y};
  }};
  const Half sky{[](int, int r) { return std::array{0.3 + 0.003 * r, 0.4 + 0.003 * r, 0.8}; }};
  TemporaryFolder folder;
  const struct {
    const Half &first, &second;
  } films[] = {{kPhoto, mirrored}, {kPhoto, upside_down}, {gray, other_gray}, {sky, sky}, {sky, kPhoto}};
  for (const auto& film : films) {
    for (const bool beside : {true, false}) {
      makeHalves(folder / "film.mp4", beside, film.first, film.second);
      const Seen seen = open({.url = folder / "film.mp4"});
      EXPECT_FALSE(seen.info.has_depth) << &film - films << beside;
      EXPECT_THAT(seen.info.reading.doubts, IsEmpty()) << &film - films << beside;
    }
  }
}

TEST(Recordings, ExchangedInputsAndOtherShapesAreTold) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {photo()});
  makeClip(folder / "depth.mkv", {ClipTrack{.pix_fmt = "gray", .width = 160, .height = 108, .frames = 2}});
  makeClip(folder / "wide.mkv", {ClipTrack{.pix_fmt = "gray", .width = 192, .height = 108, .frames = 2}});
  EXPECT_THAT(open({.url = folder / "depth.mkv", .depth_url = folder / "color.mkv"}).info.reading.doubts,
              Contains(HasSubstr("exchanged")));
  EXPECT_THAT(open({.url = folder / "color.mkv", .depth_url = folder / "wide.mkv"}).info.reading.doubts,
              Contains(HasSubstr("stretched")));
  EXPECT_THAT(open({.url = folder / "color.mkv", .depth_url = folder / "depth.mkv"}).info.reading.doubts, IsEmpty());
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
  // Without a word the picture shows it.
  const Seen shown = open({.url = folder / "color.mkv", .depth_url = folder / "%04d.png"});
  EXPECT_THAT(partLines(shown.info.reading), Contains("unit=1: first picture, likely"));
}

// What an author assumed is not said by the film's tags.
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
  EXPECT_THAT(guessed.reading.offers, Contains(HasSubstr("polarity=near-low")));
}

// A hue reaches from near to far and has no unit.
TEST(Recordings, AUnitOfHuesIsRefused) {
  TemporaryFolder folder;
  makeHalves(folder / "hue.mp4", true, {[](int c, int) { return hueColor(0.2 + 0.6 * c / kSceneCols); }}, kPhoto);
  EXPECT_THAT(open({.url = folder / "hue.mp4", .command_line = {{"unit", "1"}}}).failure, HasSubstr("hue"));
}

}  // namespace
}  // namespace relievo
