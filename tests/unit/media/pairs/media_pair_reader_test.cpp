// SPDX-License-Identifier: Apache-2.0
// Films of every packing, read as pairs: exact samples, turns and rates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/media/pairs/pairs_read.h"

namespace relievo {
namespace {

using std::chrono::milliseconds;
using test::ClipTrack;
using test::makeClip;
using test::sampleAt;
using test::TemporaryFolder;

// "colour:depth" of every pair by frame number, - for no depth, ! for a mismatch.
std::string story(const std::vector<FramePair>& pairs) {
  std::string words;
  for (const FramePair& pair : pairs) {
    if (!words.empty()) words += " ";
    words += std::to_string(numberOf(pair.color)) + ":";
    words += pair.depth.empty() ? "-" : std::to_string(numberOf(pair.depth));
    if (!pair.matched) words += "!";
  }
  return words;
}
std::string story(const SourceOptions& options) {
  PairReader reader(kFfmpeg);
  const auto opened = reader.open(options);
  if (!opened) return opened.error().message;
  return story(readAll(reader));
}

TEST(PairReader, AMaterialComesFromTheTagAndTheCommandLine) {
  TemporaryFolder folder;
  ClipTrack d = depth(25, 2);
  d.tags["DEPTH_MATERIAL"] = "stiffness=.3,friction=.2/.15";
  makeClip(folder / "a.mkv", {color(25, 2), d});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  EXPECT_EQ(reader.info().material, *parseMaterial("stiffness=.3,friction=.2/.15"));
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv", .material = *parseMaterial("friction=0")}).has_value());
  EXPECT_EQ(reader.info().material, *parseMaterial("stiffness=.3,friction=0"));
  d.tags["DEPTH_MATERIAL"] = "velvet";
  makeClip(folder / "b.mkv", {color(25, 2), d});
  ASSERT_TRUE(reader.open({.url = folder / "b.mkv"}).has_value());
  EXPECT_TRUE(reader.info().material.empty());
  EXPECT_THAT(reader.info().reading.doubts, testing::Contains(testing::HasSubstr("DEPTH_MATERIAL is left out")));
}

TEST(PairReader, TwoTracksOfOneFileArePairedAndDescribed) {
  TemporaryFolder folder;
  ClipTrack c = color(25, 50);
  ClipTrack d = depth(25, 50);
  c.width = 66, c.height = 50;
  d.tags["DEPTH_LAW"] = "inverse";
  makeClip(folder / "a.mkv", {c, d}, {{"DEPTH_LAW", "linear"}, {"DEPTH_FAR", "2500"}});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  const FilmInfo& info = reader.info();
  EXPECT_EQ(info.color_width, 66);
  EXPECT_EQ(info.depth_height, 48);
  EXPECT_EQ(info.color_codec, "ffv1");
  EXPECT_TRUE(info.has_depth);
  EXPECT_EQ(info.packing, Packing::Tracks);
  EXPECT_EQ(info.frame_period, milliseconds(40));
  EXPECT_EQ(info.duration, std::chrono::seconds(2));
  EXPECT_EQ(info.calibration.calibration.law, DepthLaw::Inverse);  // the track's tag overrides the container's
  EXPECT_EQ(info.calibration.calibration.far_mm, 2500);
  EXPECT_EQ(info.calibration.calibration.bits, 16);
  EXPECT_EQ(info.calibration.origin, CalibrationOrigin::ContainerTags);
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 50u);
  for (int k = 0; k < 50; ++k) {
    const FramePair& pair = pairs[static_cast<std::size_t>(k)];
    EXPECT_EQ(numberOf(pair.color), k);
    EXPECT_EQ(numberOf(pair.depth), k);
    EXPECT_EQ(pair.color.pts, MediaTime(k * milliseconds(40)));
    EXPECT_EQ(pair.depth.pts, pair.color.pts);
  }
  EXPECT_EQ(reader.counters().pairs, 50u);
  EXPECT_EQ(reader.counters().mismatched, 0u);
}

// Sample codes give their original position: 100 row + column.
TEST(PairReader, TracksThatWereTakenOnTheirSideComeUpright) {
  TemporaryFolder folder;
  const auto place = [](int, int column, int row, int) { return static_cast<std::uint32_t>(100 * row + column); };
  ClipTrack c = color(30, 2), d = depth(30, 2);
  d.sample = place;
  c.rotation = 90, d.rotation = 90;
  makeClip(folder / "a.mov", {c, d});
  c.rotation = -90, d.rotation.reset();
  makeClip(folder / "color.mov", {c});
  d.rotation = 180;
  makeClip(folder / "depth.mov", {d});

  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mov"}).has_value());
  EXPECT_EQ(reader.info().color_width, 48);
  EXPECT_EQ(reader.info().depth_height, 64);
  const Frame quarter = readAll(reader).at(1).depth;
  EXPECT_EQ(sampleAt(quarter, 0, 47, 0), 0u);  // the top left corner moves to the top right
  EXPECT_EQ(sampleAt(quarter, 0, 0, 0), 4700u);
  EXPECT_EQ(sampleAt(quarter, 0, 47, 63), 63u);

  ASSERT_TRUE(reader.open({.url = folder / "color.mov", .depth_url = folder / "depth.mov"}).has_value());
  EXPECT_EQ(reader.info().color_width, 48);
  EXPECT_EQ(reader.info().depth_width, 64);
  EXPECT_EQ(sampleAt(readAll(reader).at(0).depth, 0, 0, 0), 4763u);
}

// Left half 100 row + column, right half 10,000 more; every turn keeps the halves of the upright picture.
TEST(PairReader, APackedFilmIsHalvedUprightInEveryTurn) {
  TemporaryFolder folder;
  for (int turns = 0; turns < 4; ++turns) {
    const int across = turns % 2 == 0 ? 64 : 48, down = turns % 2 == 0 ? 48 : 64;  // upright
    ClipTrack packed = depth(30, 2);
    packed.sample = [&](int, int column, int row, int) {
      int c = column, r = row, cols = 64, rows = 48;
      for (int i = 0; i < turns; ++i) {  // a quarter turn clockwise
        std::tie(c, r) = std::pair(rows - 1 - r, c);
        std::swap(cols, rows);
      }
      return static_cast<std::uint32_t>(100 * r + c + (c >= cols / 2 ? 10'000 : 0));
    };
    packed.rotation = 90 * turns;
    makeClip(folder / "a.mov", {packed});
    PairReader reader(kFfmpeg);
    ASSERT_TRUE(reader.open({.url = folder / "a.mov", .packing = Packing::SideBySide}).has_value());
    const FramePair pair = readAll(reader).at(0);
    EXPECT_EQ(pair.color.width, across / 2);
    EXPECT_EQ(pair.depth.height, down);
    EXPECT_EQ(sampleAt(pair.color, 0, 0, 0), 0u) << turns;
    EXPECT_EQ(sampleAt(pair.color, 0, 3, down - 1), static_cast<unsigned>(100 * (down - 1) + 3)) << turns;
    EXPECT_EQ(sampleAt(pair.depth, 0, 0, 0), static_cast<unsigned>(10'000 + across / 2)) << turns;
  }
}

TEST(PairReader, ATurnThatIsNoQuarterTurnIsTold) {
  TemporaryFolder folder;
  ClipTrack c = color(30, 2);
  c.rotation = 30;
  makeClip(folder / "a.mov", {c});
  PairReader reader(kFfmpeg);
  testing::internal::CaptureStderr();
  const auto opened = reader.open({.url = folder / "a.mov"});
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::HasSubstr("turned by other than a multiple of 90 degrees, which is not supported"));
  ASSERT_TRUE(opened.has_value());
  EXPECT_EQ(reader.info().color_width, 64);
}

TEST(PairReader, TheFramePeriodIsFreeOfTheContainersRounding) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {color(30, 3)});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  EXPECT_NEAR(toSeconds(reader.info().frame_period), 1.0 / 30, 1e-8);  // though its timestamps are 0, 33, 67 ms
}

// As from a renderer: colour with timestamps, depth without.
TEST(PairReader, PicturesWithoutTimesComeAtTheRateThatIsTold) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {color(20, 10)});
  ClipTrack numbered = depth(25, 10);
  numbered.codec = "png", numbered.pix_fmt = "gray16be";
  makeClip(folder / "%02d.png", {numbered});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(
      reader.open({.url = folder / "color.mkv", .depth_url = folder / "%02d.png", .frames_per_s = 20}).has_value());
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 10u);
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(numberOf(pairs[static_cast<std::size_t>(k)].depth), k);
    EXPECT_EQ(pairs[static_cast<std::size_t>(k)].depth.pts, MediaTime(k * milliseconds(50)));
  }
}

TEST(PairReader, RatesAndEndsAreToldByTimestamps) {
  TemporaryFolder folder;
  makeClip(folder / "half.mkv", {color(30, 6), depth(15, 3)});
  EXPECT_EQ(story({.url = folder / "half.mkv"}), "0:0 1:0 2:1 3:1 4:2 5:2");
  makeClip(folder / "double.mkv", {color(30, 4), depth(60, 8)});
  EXPECT_EQ(story({.url = folder / "double.mkv"}), "0:0 1:2 2:4 3:6");
  makeClip(folder / "film.mkv", {color(24, 6), depth(30, 8)});
  EXPECT_EQ(story({.url = folder / "film.mkv"}), "0:0 1:1 2:2 3:3 4:5 5:6");
  makeClip(folder / "short-depth.mkv", {color(30, 6), depth(30, 3)});
  EXPECT_EQ(story({.url = folder / "short-depth.mkv"}), "0:0 1:1 2:2 3:- 4:- 5:-");
  makeClip(folder / "short-color.mkv", {color(30, 3), depth(30, 6)});
  EXPECT_EQ(story({.url = folder / "short-color.mkv"}), "0:0 1:1 2:2");
  ClipTrack later = depth(30, 4);
  later.start = milliseconds(40);
  makeClip(folder / "later.mkv", {color(30, 4), later});
  EXPECT_EQ(story({.url = folder / "later.mkv"}), "0:- 1:- 2:0 3:1");
}

// As scripts write depth that round a film's 29.97 pictures a second down.
TEST(PairReader, TwoFilesOfAsManyPicturesArePairedByNumber) {
  TemporaryFolder folder;
  ClipTrack c = color(30, 90);
  c.fps_num = 30000, c.fps_den = 1001;
  makeClip(folder / "color.mkv", {c});
  makeClip(folder / "depth.mkv", {depth(29, 90)});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "color.mkv", .depth_url = folder / "depth.mkv"}).has_value());
  EXPECT_THAT(reader.info().notes, testing::Contains(testing::HasSubstr("90 pictures each, of 29.97 and 29 a second")));
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 90u);
  for (int k = 0; k < 90; ++k) EXPECT_EQ(numberOf(pairs[static_cast<std::size_t>(k)].depth), k);
  ASSERT_TRUE(reader.seek(mediaTime(2)).has_value());
  const auto there = reader.next();
  ASSERT_TRUE(there && *there);
  EXPECT_EQ(numberOf((*there)->depth), numberOf((*there)->color));
}

TEST(PairReader, TwoFilesOfOtherLengthsAreToldAndPairedByTime) {
  TemporaryFolder folder;
  makeClip(folder / "color.mkv", {color(30, 12)});
  makeClip(folder / "depth.mkv", {depth(15, 3)});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "color.mkv", .depth_url = folder / "depth.mkv"}).has_value());
  EXPECT_THAT(reader.info().notes,
              testing::Contains("the depth lasts 0.2 s, the colour 0.4 s: they are paired by time"));
  EXPECT_EQ(numberOf(readAll(reader).at(4).depth), 2);
}

TEST(PairReader, AMissingDepthPictureIsAMismatch) {
  TemporaryFolder folder;
  ClipTrack gaps = depth(25, 8);
  gaps.time = [](int k) -> std::optional<Duration> {
    if (k == 3 || k == 5 || k == 6) return std::nullopt;
    return k * milliseconds(40);
  };
  makeClip(folder / "a.mkv", {color(25, 8), gaps});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  EXPECT_EQ(story(readAll(reader)), "0:0 1:1 2:2 3:2! 4:4 5:4! 6:4! 7:7");
  EXPECT_EQ(reader.counters().mismatched, 3u);
}

TEST(PairReader, TwoFilesBeginTogetherWhateverTheirContainersStartWith) {
  TemporaryFolder folder;
  ClipTrack late = depth(30, 5);
  late.start = std::chrono::seconds(3);
  makeClip(folder / "color.mp4", {{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 5}});
  makeClip(folder / "depth.mkv", {late});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "color.mp4", .depth_url = folder / "depth.mkv"}).has_value());
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 5u);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(numberOf(pairs[static_cast<std::size_t>(k)].depth), k);
}

TEST(PairReader, APlainFilmIsColourAlone) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {color(30, 3)});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  EXPECT_FALSE(reader.info().has_depth);
  EXPECT_EQ(story(readAll(reader)), "0:- 1:- 2:-");
}

TEST(PairReader, AStillDepthIsHeldForTheWholeFilm) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {color(30, 4)});
  makeClip(folder / "d.png", {{.codec = "png", .pix_fmt = "gray16be", .frames = 1, .sample = frameNumber}});
  EXPECT_EQ(story({.url = folder / "a.mkv", .depth_url = folder / "d.png"}), "0:0 1:0 2:0 3:0");
}

// Left half 100 + column, right half 1000 + 10 columns (16 bits), in one picture of odd size.
TEST(PairReader, HalvesOfAPackedPictureAreExact) {
  TemporaryFolder folder;
  ClipTrack packed{.pix_fmt = "yuv420p16le", .width = 129, .height = 33, .frames = 3};
  packed.sample = [](int component, int c, int r, int k) -> std::uint32_t {
    if (component > 0) return 30000;
    return static_cast<std::uint32_t>(c < 64 ? 100 + c + r + k : c == 64 ? 0 : 1000 + 10 * (c - 65) + r + k);
  };
  makeClip(folder / "a.mkv", {packed}, {{"DEPTH_PACKING", "sbs"}});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  EXPECT_EQ(reader.info().packing, Packing::SideBySide);
  EXPECT_EQ(reader.info().color_width, 64);
  EXPECT_EQ(reader.info().depth_width, 64);
  EXPECT_EQ(reader.info().depth_height, 33);
  EXPECT_EQ(reader.info().calibration.calibration.range, ColorRange::Full) << "the codes lie below limited black";
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    const FramePair& pair = pairs[static_cast<std::size_t>(k)];
    EXPECT_TRUE(pair.matched);
    EXPECT_EQ(pair.depth.pts, pair.color.pts);
    for (int r = 0; r < 33; ++r) {
      for (int c = 0; c < 64; ++c) {
        ASSERT_EQ(sampleAt(pair.color, 0, c, r), static_cast<std::uint32_t>(100 + c + r + k));
        ASSERT_EQ(sampleAt(pair.depth, 0, c, r), static_cast<std::uint32_t>(1000 + 10 * c + r + k));
      }
    }
  }
}

TEST(PairReader, TheLowerHalfOfAPackedPictureIsDepthWhenAskedFor) {
  TemporaryFolder folder;
  ClipTrack packed{.pix_fmt = "gray", .width = 32, .height = 41, .frames = 1};
  packed.sample = [](int, int c, int r, int) {
    return static_cast<std::uint32_t>(r < 20 ? c : r == 20 ? 255 : 100 + c);
  };
  makeClip(folder / "a.mkv", {packed});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv", .packing = Packing::TopBottom}).has_value());
  EXPECT_EQ(reader.info().depth_height, 20);
  const auto pair = reader.next().value().value();
  for (int r = 0; r < 20; ++r) {
    EXPECT_EQ(sampleAt(pair.color, 0, 31, r), 31u);
    EXPECT_EQ(sampleAt(pair.depth, 0, 31, r), 131u);
  }
}

}  // namespace
}  // namespace relievo
