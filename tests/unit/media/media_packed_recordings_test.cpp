// SPDX-License-Identifier: Apache-2.0
// Depth in half of a picture, in hues and in gray: found without any option.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

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
using test::hueColor;
using test::kSceneCols;
using test::kSceneRows;
using test::makeClip;
using test::TemporaryFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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

// Of a scene that goes on beyond 3 m, where red begins: the hues up to there are distances.
TEST(Recordings, Record3DReachesItsThreeMetres) {
  const auto mm = [](int c, int r) { return 1.6 * distanceMm(c, r); };
  const auto isHole = [&](int c, int r) { return mm(c, r) == 0 || mm(c, r) >= 3000; };
  const Half hue{[&](int c, int r) { return hueColor(isHole(c, r) ? 0 : mm(c, r) / 3000); }};
  std::vector<double> distances;
  for (int i = 0; i < kSceneCols * kSceneRows; ++i) {
    const int c = i % kSceneCols, r = i / kSceneCols;
    if (!isHole(c, r)) distances.push_back(mm(c, r));
  }
  std::ranges::sort(distances);
  const double holes = 1 - static_cast<double>(distances.size()) / (kSceneCols * kSceneRows);
  TemporaryFolder folder;
  makeHalves(folder / "tagged.mp4", true, hue, kPhoto,
             {{"comment", R"({"intrinsicMatrix":[400,0,0,0,400,0,80,54,1],"rangeOfEncodedDepth":[0,3]})"}});
  makeHalves(folder / "plain.mp4", true, hue, kPhoto);
  for (const char* name : {"tagged.mp4", "plain.mp4"}) {
    const Seen seen = open({.url = folder / name});
    ASSERT_EQ(seen.failure, "");
    EXPECT_NEAR(measure(seen).median, distances[distances.size() / 2], 0.01 * distances[distances.size() / 2]) << name;
    EXPECT_NEAR(measure(seen).holes, holes, 0.01) << name;
    EXPECT_THAT(seen.info.calibration.calibration.invalid.text(), HasSubstr("+1524-1536")) << name;
  }
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
    EXPECT_THAT(seen.info.reading.doubts, Contains(HasSubstr("polarity=near-low"))) << name;
  }
}

// The picture of a white room with one blue object is nearly as gray as its depth. The halves are found by the break in
// the picture where they meet.
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

// Without a hole, nothing in a picture shows whether high codes are near. The message names both possibilities.
TEST(Recordings, AFilmOfOneKeyFrameIsLookedAtFartherOnToo) {
  TemporaryFolder folder;
  ClipTrack depth{.width = kSceneCols, .height = kSceneRows, .frames = 48, .gop = 1000};
  // A wall that comes into view little by little.
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
  // Only a sensor leaves holes.
  makeClip(folder / "%04d.png", {coded([](double mm, int, int) { return rounded(mm); })});
  EXPECT_THAT(open({.url = folder / "%04d.png"}).info.reading.offers, ElementsAre(HasSubstr("unit=MM")));
  std::filesystem::create_directories(folder / "elevation");
  makeClip(folder / "elevation/%04d.png", {coded([](double mm, int, int) { return 20000 - rounded(mm); })});
  EXPECT_THAT(open({.url = folder / "elevation/%04d.png"}).info.calibration.calibration.polarity,
              DepthPolarity::NearIsHigh);
}

TEST(Recordings, HuesTellThatTheirNearEndIsAGuess) {
  TemporaryFolder folder;
  const Half hue{[](int c, int r) { return hueColor(0.1 + 0.8 * (distanceMm(c, r) - 900) / 1500); }};
  makeHalves(folder / "a.mp4", true, kPhoto, hue);
  EXPECT_THAT(open({.url = folder / "a.mp4"}).info.reading.doubts, Contains(HasSubstr("polarity=near-high")));
  const FilmReading said = open({.url = folder / "a.mp4", .command_line = {{"polarity", "near-low"}}}).info.reading;
  EXPECT_THAT(said.offers, IsEmpty());
  EXPECT_THAT(said.doubts, IsEmpty());
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
  EXPECT_THAT(found.reading.doubts, Contains(HasSubstr("polarity=near-low")));
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
  EXPECT_THAT(seen.info.notes, Contains(HasSubstr("clip-depth.mkv beside the film")));
  EXPECT_THAT(open({.url = folder / "clip.mkv", .packing = Packing::SideBySide}).info.notes,
              testing::Not(Contains(HasSubstr("lies beside it"))));
  std::ofstream(folder / "clip-depth.mkv") << "no film";
  const Seen flat = open({.url = folder / "clip.mkv"});
  EXPECT_EQ(flat.failure, "");
  EXPECT_FALSE(flat.info.has_depth);
  EXPECT_THAT(flat.info.notes, Contains(HasSubstr("cannot be read as depth")));
}

// A hue reaches from near to far and has no unit.
TEST(Recordings, AUnitOfHuesIsRefused) {
  TemporaryFolder folder;
  makeHalves(folder / "hue.mp4", true, {[](int c, int) { return hueColor(0.2 + 0.6 * c / kSceneCols); }}, kPhoto);
  EXPECT_THAT(open({.url = folder / "hue.mp4", .command_line = {{"unit", "1"}}}).failure, HasSubstr("hue"));
}

// A GIF (GIF89a) of two pictures, its 125 colours mixed in a pattern of 2 x 2: five shades of red, green and blue.
// LZW begins anew before its codes grow, so that each code is a byte.
std::string gifOf(int cols, int rows, const std::function<std::array<double, 3>(int c, int r)>& color) {
  constexpr int kClear = 128, kEnd = 129, kUntilClear = 100, kMostBlock = 250;
  const auto word = [](int value) {
    return std::string{static_cast<char>(value & 255), static_cast<char>(value >> 8)};
  };
  std::string codes;
  for (int i = 0; i < cols * rows; ++i) {
    if (i % kUntilClear == 0) codes += static_cast<char>(kClear);
    const int c = i % cols, r = i / cols;
    int index = 0, component = 0;
    for (const double part : color(c, r)) {
      const double threshold = 0.125 + 0.25 * (2 * ((r + component++) % 2) + (c + r) % 2);
      index = 5 * index + std::clamp(static_cast<int>(4 * part + threshold), 0, 4);
    }
    codes += static_cast<char>(index);
  }
  codes += static_cast<char>(kEnd);
  std::string blocks;
  for (std::size_t at = 0; at < codes.size(); at += kMostBlock) {
    const std::string block = codes.substr(at, kMostBlock);
    blocks += static_cast<char>(block.size()) + block;
  }
  std::string gif = "GIF89a" + word(cols) + word(rows) + std::string("\xf6\0\0", 3);
  for (int i = 0; i < 128; ++i) {
    for (const int shade : {i / 25 % 5, i / 5 % 5, i % 5}) gif += static_cast<char>(255 * shade / 4);
  }
  const std::string picture = std::string("\x21\xf9\4\0\x0a\0\0\0", 8) + "," + word(0) + word(0) + word(cols) +
                              word(rows) + std::string("\0\7", 2) + blocks + std::string(1, '\0');
  return gif + picture + picture + ";";
}

TEST(Recordings, HalvesOfAGifAreFoundAlthoughItsGrayIsMixed) {
  TemporaryFolder folder;
  const auto gray = [](int c) { return 0.1 + 0.8 * c / kSceneCols; };
  std::ofstream(folder / "a.gif", std::ios::binary)
      << gifOf(2 * kSceneCols, kSceneRows, [&](int c, int r) -> std::array<double, 3> {
           if (c >= kSceneCols) return {gray(c - kSceneCols), gray(c - kSceneCols), gray(c - kSceneCols)};
           return test::photoOf(c, r);
         });
  const Seen seen = open({.url = folder / "a.gif"});
  ASSERT_EQ(seen.failure, "");
  EXPECT_EQ(seen.info.packing, Packing::SideBySide);
  EXPECT_THAT(seen.info.reading.doubts, ElementsAre(HasSubstr("nothing says which end")));
  const HeightField field = HeightField::make(seen.depth, seen.info.calibration.calibration, kVolume).value();
  for (const int column : {20, 60, 100}) {
    double sum = 0;
    for (int i = 0; i < 64; ++i) sum += field.heightMm(column + i % 8, 20 + i / 8) / 64;
    EXPECT_NEAR(sum / kVolume.depth_mm, gray(column + 4), 0.05) << column;
  }
}

TEST(Recordings, AGifOfAFewRowsOrColumnsIsAFilmWithoutDepth) {
  TemporaryFolder folder;
  for (const auto& [cols, rows] : {std::pair{200, 2}, {3, 40}}) {
    std::ofstream(folder / "a.gif", std::ios::binary) << gifOf(cols, rows, test::photoOf);
    const Seen seen = open({.url = folder / "a.gif"});
    EXPECT_EQ(seen.failure, "") << cols;
    EXPECT_EQ(seen.info.packing, Packing::Tracks) << cols;
  }
}

// Metavido: hues above a mask of persons in red, with codes in blue at its corner; the colour right of both.
TEST(Recordings, AMaskBelowTheHuesIsTold) {
  const TemporaryFolder folder;
  for (const bool mask : {true, false}) {
    const Half depth{[mask](int c, int r) {
      if (!mask || 2 * r < kSceneRows) return test::hueColor(0.2 + 0.5 * c / kSceneCols);
      const bool person = std::abs(c - kSceneCols / 2) < 30, code = c < 24 && (c / 8 + r / 8) % 2 == 0;
      return std::array{person ? 1.0 : 0.0, 0.0, code ? 1.0 : 0.0};
    }};
    makeHalves(folder / "film.mp4", true, depth, kPhoto);
    const FilmInfo info = open({.url = folder / "film.mp4"}).info;
    EXPECT_EQ(info.packing, Packing::SideBySideDepthFirst);
    EXPECT_EQ(testing::Matches(Contains(HasSubstr("Metavido")))(info.notes), mask);
    EXPECT_THAT(info.notes, testing::Not(Contains(HasSubstr("three pictures"))));
  }
}

}  // namespace
}  // namespace relievo
