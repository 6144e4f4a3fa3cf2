// SPDX-License-Identifier: Apache-2.0
// Films of every packing, read as pairs: exact samples, rates, seeks, losses, real depth video.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <tuple>

#include "app/media/pair_reader.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/mock/mock.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using std::chrono::milliseconds;
using test::ClipTrack;
using test::makeClip;
using test::sampleAt;
using test::TemporaryFolder;

const PairReader::Backends kFfmpeg{[](const std::string&) { return makeFfmpegSource(); },
                                   [](const StreamInfo&) { return makeFfmpegDecoder(); }};

// Every sample of frame k is k, so that a picture identifies its frame.
std::uint32_t frameNumber(int /*component*/, int /*column*/, int /*row*/, int frame) {
  return static_cast<std::uint32_t>(frame);
}

ClipTrack color(int fps = 30, int frames = 30) {
  return {.pix_fmt = "yuv420p", .fps_num = fps, .frames = frames, .sample = frameNumber};
}
ClipTrack depth(int fps = 30, int frames = 30) {
  return {.fps_num = fps, .frames = frames, .sample = frameNumber, .tags = {{"title", "depth"}}};
}

int numberOf(const Frame& frame) {
  return frame.empty() ? -1 : static_cast<int>(sampleAt(frame, 0, 5, 5));
}

std::vector<FramePair> readAll(PairReader& reader) {
  std::vector<FramePair> pairs;
  for (;;) {
    auto pair = reader.next();
    EXPECT_TRUE(pair.has_value());
    if (!pair || !*pair) return pairs;
    pairs.push_back(std::move(**pair));
  }
}

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
              testing::HasSubstr("turned by an odd angle, which is not supported"));
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

// ---- seeking

struct SeekCase {
  const char* name;
  const char* file;
  ClipTrack color, depth;
};
void PrintTo(const SeekCase& c, std::ostream* out) {
  *out << c.name;
}
class Seeks : public testing::TestWithParam<SeekCase> {};

// A seek to any time (of a frame, between frames, beyond the end) gives the same pair as reading in order.
TEST_P(Seeks, LandOnTheFirstPairAtOrAfterTheTarget) {
  TemporaryFolder folder;
  makeClip(folder / GetParam().file, {GetParam().color, GetParam().depth});
  const SourceOptions options{.url = folder / GetParam().file};
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open(options).has_value());
  const auto pairs = readAll(reader);
  const std::size_t count = pairs.size();
  ASSERT_EQ(count, static_cast<std::size_t>(GetParam().color.frames));
  const auto sameAs = [&](std::size_t k) {
    const auto found = reader.next().value();
    ASSERT_TRUE(found.has_value()) << k;
    EXPECT_EQ(found->color.pts, pairs[k].color.pts) << k;
    EXPECT_EQ(numberOf(found->color), numberOf(pairs[k].color)) << k;
    EXPECT_EQ(numberOf(found->depth), numberOf(pairs[k].depth)) << k;
    EXPECT_EQ(found->depth.pts, pairs[k].depth.pts) << k;
    EXPECT_EQ(found->matched, pairs[k].matched) << k;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = i * 7 % count;  // back and forth
    ASSERT_TRUE(reader.seek(pairs[k].color.pts).has_value());
    sameAs(k);
    if (k + 1 < count) sameAs(k + 1);
    ASSERT_TRUE(reader.seek(pairs[k].color.pts - Duration(1)).has_value());
    sameAs(k);
    ASSERT_TRUE(reader.seek(pairs[k].color.pts + Duration(1)).has_value());
    if (k + 1 < count) {
      sameAs(k + 1);
    } else {
      EXPECT_FALSE(reader.next().value().has_value());
    }
  }
  ASSERT_TRUE(reader.seek(mediaTime(-5)).has_value());
  sameAs(0);
  ASSERT_TRUE(reader.seek(mediaTime(1e4)).has_value());
  EXPECT_FALSE(reader.next().value().has_value());
  ASSERT_TRUE(reader.seek(MediaTime{}).has_value());
  for (std::size_t k = 0; k < count; ++k) sameAs(k);
}

ClipTrack h264(int fps, int frames, int gop, int b_frames, Duration start = Duration(0)) {
  return {.codec = "libx264",
          .pix_fmt = "yuv420p",
          .fps_num = fps,
          .frames = frames,
          .start = start,
          .gop = gop,
          .b_frames = b_frames,
          .sample = [](int component, int, int, int k) -> std::uint32_t {
            return component > 0 ? 128 : static_cast<std::uint32_t>(k * 3);
          },
          .options = {{"qp", "1"}}};
}

INSTANTIATE_TEST_SUITE_P(
    PairReader, Seeks,
    testing::Values(SeekCase{"Matroska", "a.mkv", h264(25, 48, 12, 0), h264(25, 48, 12, 0)},
                    SeekCase{"MatroskaReordered", "a.mkv", h264(30, 48, 12, 2), h264(30, 48, 12, 2)},
                    SeekCase{"Mp4Reordered", "a.mp4", h264(30, 48, 12, 2), h264(30, 48, 12, 2)},
                    SeekCase{"Mp4OtherGopAndRate", "a.mp4", h264(30, 60, 12, 2), h264(15, 30, 25, 1)},
                    SeekCase{"MatroskaOtherGopAndRate", "a.mkv", h264(24, 60, 10, 2), h264(30, 75, 40, 0)},
                    SeekCase{"TransportStream", "a.ts", h264(30, 48, 12, 2), h264(30, 48, 12, 2)},
                    SeekCase{"AdaptiveStream", "a.m3u8", h264(25, 100, 25, 2), h264(25, 100, 25, 2)},
                    SeekCase{"LateStart", "a.mkv", h264(25, 48, 12, 2, milliseconds(700)),
                             h264(25, 40, 12, 2, milliseconds(780))},
                    SeekCase{"DepthOfKeyFramesAlone", "a.mkv", h264(25, 48, 12, 2), depth(25, 48)},
                    SeekCase{"ShortDepth", "a.mkv", h264(25, 100, 12, 2), h264(25, 30, 12, 0)},
                    SeekCase{"ColourOfKeyFramesAlone", "a.mkv", color(25, 48), h264(25, 48, 20, 2)}),
    [](const auto& seek) { return std::string(seek.param.name); });

TEST(PairReader, SeeksInTwoFilesAndInNumberedPictures) {
  TemporaryFolder folder;
  makeClip(folder / "c.mkv", {h264(25, 48, 12, 2)});
  makeClip(folder / "%02d.png", {{.codec = "png", .pix_fmt = "gray", .frames = 48, .sample = frameNumber}});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "c.mkv", .depth_url = folder / "%02d.png"}).has_value());
  for (const int k : {30, 5, 47, 0, 24}) {
    ASSERT_TRUE(reader.seek(MediaTime(k * milliseconds(40))).has_value());
    const auto pair = reader.next().value().value();
    EXPECT_EQ(pair.color.pts, MediaTime(k * milliseconds(40)));
    EXPECT_EQ(numberOf(pair.depth), k);
  }
}

TEST(PairReader, ASeekCountsNothingAsSkipped) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {h264(25, 48, 12, 0), h264(25, 48, 12, 0)});
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  for (const int k : {30, 7, 47}) {
    ASSERT_TRUE(reader.seek(MediaTime(k * milliseconds(40))).has_value());
    ASSERT_TRUE(reader.next().has_value());
  }
  EXPECT_EQ(reader.counters().depth_skipped, 0u);
  EXPECT_EQ(reader.counters().pairs, 3u);
}

// ---- what goes wrong

std::string failureOf(const SourceOptions& options, std::string& thing) {
  PairReader reader(kFfmpeg);
  const auto opened = reader.open(options);
  EXPECT_FALSE(opened.has_value());
  thing = reader.failedThing();
  return opened ? "" : opened.error().message;
}

TEST(PairReader, SaysWhichThingFailedAndWhy) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {color(30, 3)});
  const std::string film = folder / "a.mkv";
  const std::string none = folder / "none.mkv";
  std::string thing;
  EXPECT_THAT(failureOf({.url = none}, thing), testing::HasSubstr("no such file"));
  EXPECT_EQ(thing, none);
  EXPECT_THAT(failureOf({.url = film, .depth_url = none}, thing), testing::HasSubstr("no such file"));
  EXPECT_EQ(thing, none);
  EXPECT_THAT(failureOf({.url = film, .packing = Packing::Tracks}, thing), testing::HasSubstr("only one video track"));
  EXPECT_EQ(thing, film);
  EXPECT_THAT(failureOf({.url = film, .depth_url = film, .packing = Packing::TopBottom}, thing),
              testing::HasSubstr("cannot be packed"));
  EXPECT_THAT(failureOf({.url = film, .depth_url = film, .command_line = {{"near", "9"}, {"far", "1"}}}, thing),
              testing::HasSubstr("far"));
  EXPECT_EQ(thing, "calibration");
}

TEST(PairReader, ACutFilmPlaysWhatIsThere) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {color(30, 60), depth(30, 60)});
  std::filesystem::resize_file(folder / "a.mkv", std::filesystem::file_size(folder / "a.mkv") / 2);
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  const auto pairs = readAll(reader);
  EXPECT_GT(pairs.size(), 10u);
  EXPECT_LT(pairs.size(), 60u);
  for (std::size_t k = 0; k + 2 < pairs.size(); ++k) {
    EXPECT_EQ(numberOf(pairs[k].color), static_cast<int>(k));
    EXPECT_EQ(numberOf(pairs[k].depth), static_cast<int>(k));
  }
}

// Films of the mock back end, which can be told to fail.
struct MockFilm {
  ManualClock clock;
  MockMediaProfile color, depth;
  int sources = 0;
  PairReader reader{{[this](const std::string&) { return makeMockSource(sources++ == 0 ? color : depth, clock); },
                     [](const StreamInfo&) { return makeMockDecoder(); }}};
};

TEST(PairReader, AFilmWithoutOnePictureDoesNotOpen) {
  MockFilm film;
  film.color.damaged_every = 1;
  const auto opened = film.reader.open({.url = "color"});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::Corrupt);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("not one picture"));
  EXPECT_EQ(film.reader.failedThing(), "color");
}

TEST(PairReader, DepthAskedForByNameHasToBeThere) {
  MockFilm film;
  film.depth.damaged_every = 1;
  const auto opened = film.reader.open({.url = "color", .depth_url = "depth"});
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::Corrupt);
  EXPECT_EQ(film.reader.failedThing(), "depth");
}

// Two tracks of one film, the second without a picture: the film plays flat, with a warning.
TEST(PairReader, DepthThatIsFoundAndCannotBeReadIsGivenUp) {
  MockFilm film;
  film.color.tracks = {MockTrack{.frames = 5}, MockTrack{.frames = 0}};
  testing::internal::CaptureStderr();
  ASSERT_TRUE(film.reader.open({.url = "film"}).has_value());
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("film: no depth from here on"));
  EXPECT_FALSE(film.reader.info().has_depth);
  int pairs = 0;
  while (const auto pair = film.reader.next().value()) {
    EXPECT_TRUE(pair->depth.empty());
    ++pairs;
  }
  EXPECT_EQ(pairs, 5);
}

TEST(PairReader, LostDepthEndsTheDepthAndNotTheFilm) {
  MockFilm film;
  film.color.tracks[0].frames = film.depth.tracks[0].frames = 30;
  film.depth.lose_after_packets = 10;
  ASSERT_TRUE(film.reader.open({.url = "color", .depth_url = "depth"}).has_value());
  testing::internal::CaptureStderr();
  int with_depth = 0, pairs = 0;
  while (const auto pair = film.reader.next().value()) {
    ++pairs;
    EXPECT_TRUE(pair->matched);
    if (!pair->depth.empty()) ++with_depth;
  }
  ASSERT_TRUE(film.reader.seek(MediaTime{}).has_value());  // finds no depth again
  EXPECT_TRUE(film.reader.next().value()->depth.empty());
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(pairs, 30);
  EXPECT_GE(with_depth, 8);
  EXPECT_LE(with_depth, 10);
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_THAT(said, testing::HasSubstr("depth: no depth from here on"));
}

// A source that fails one read and then works again, like a network connection.
class OnceFailingSource final : public MediaSource {
 public:
  OnceFailingSource(std::unique_ptr<MediaSource> source, int good_reads, ErrorCode code)
      : source_(std::move(source)), reads_left_(good_reads), code_(code) {}

 private:
  Result<Description> openSource(const std::string& url) override {
    if (auto opened = source_->open(url); !opened) return std::unexpected(opened.error());
    return Description{source_->streams(), source_->tags(), source_->duration()};
  }
  Result<std::optional<Packet>> readPacket() override {
    if (reads_left_-- == 0) return fail(code_, "the network has gone");
    return source_->read();
  }
  Result<void> seekTo(MediaTime target) override { return source_->seek(target); }
  void closeSource() noexcept override { source_->close(); }
  void interrupted() noexcept override { source_->interrupt(); }
  std::unique_ptr<MediaSource> source_;
  int reads_left_;
  ErrorCode code_;
};

// The eleventh read of the depth's source fails.
PairReader::Backends onceFailingDepth(Clock& clock, ErrorCode code) {
  return {[&clock, code, sources = 0](const std::string&) mutable -> std::unique_ptr<MediaSource> {
            auto source = makeMockSource({}, clock);
            if (sources++ == 0) return source;
            return std::make_unique<OnceFailingSource>(std::move(source), 10, code);
          },
          [](const StreamInfo&) { return makeMockDecoder(); }};
}

TEST(PairReader, AnInterruptionIsNoLossOfDepth) {
  ManualClock clock;
  PairReader reader(onceFailingDepth(clock, ErrorCode::Cancelled));
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  for (int k = 0; k < 9; ++k) ASSERT_TRUE(reader.next().has_value());
  const auto pair = reader.next();
  ASSERT_FALSE(pair.has_value());
  EXPECT_EQ(pair.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(reader.failedThing(), "depth");
  EXPECT_FALSE(reader.next().value()->depth.empty());
}

TEST(PairReader, ASeekFindsLostDepthAgain) {
  ManualClock clock;
  PairReader reader(onceFailingDepth(clock, ErrorCode::Lost));
  testing::internal::CaptureStderr();
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  for (int k = 0; k < 20; ++k) ASSERT_EQ(reader.next().value()->depth.empty(), k >= 9) << k;  // one is read ahead
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("the network has gone"));
  ASSERT_TRUE(reader.seek(mediaTime(0.5)).has_value());
  for (int k = 0; k < 20; ++k) {
    const auto pair = reader.next().value();
    EXPECT_EQ(pair->depth.pts, pair->color.pts);
  }
}

// ---- two sources over a network

MockMediaProfile live(int frames) {
  MockMediaProfile profile{.tracks = {MockTrack{.frames = frames, .frame_period = milliseconds(40)}}};
  profile.live = profile.remote = true;
  return profile;
}

// The source made second is opened later.
PairReader::Backends twoLive(const MockMediaProfile& color, const MockMediaProfile& depth, ManualClock& clock,
                             Duration later) {
  return {.make_source =
              [=, &clock, made = 0](const std::string&) mutable {
                const bool second = made++ % 2 == 1;
                if (second) clock.advance(later);
                return makeMockSource(second ? depth : color, clock);
              },
          .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32}); },
          .clock = &clock};
}

// A picture's number, from the motion of its slope.
int slopeNumber(const Frame& frame) {
  return static_cast<int>(sampleAt(frame, 0, 0, 0)) / 2;
}

// Pictures that arrive at the same time belong together: the depth's first picture and the colour's 25th, with which
// the film begins.
TEST(PairReader, TwoLiveSourcesMeetByTheirArrivalHere) {
  ManualClock clock;
  PairReader reader(twoLive(live(100), live(100), clock, std::chrono::seconds(1)));
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  for (int k = 25; k < 60; ++k) {
    const auto pair = reader.next().value();
    EXPECT_EQ(slopeNumber(pair->color), k);
    EXPECT_EQ(slopeNumber(pair->depth), k - 25);
    EXPECT_EQ(pair->depth.pts, pair->color.pts);
  }
}

TEST(PairReader, TwoLiveSourcesOfOneSenderMeetByItsClock) {
  ManualClock clock;
  MockMediaProfile color = live(100), depth = live(100);
  color.sender_start = std::chrono::hours(5);
  depth.sender_start = std::chrono::hours(5) + milliseconds(400);
  PairReader reader(twoLive(color, depth, clock, std::chrono::seconds(1)));
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  const auto pair = reader.next().value();
  EXPECT_EQ(slopeNumber(pair->color), 10);
  EXPECT_EQ(slopeNumber(pair->depth), 0);
}

TEST(PairReader, TwoLiveSourcesOfTwoSendersMeetByTheirArrival) {
  ManualClock clock;
  MockMediaProfile color = live(100), depth = live(100);
  color.sender_start = std::chrono::hours(5);
  depth.sender_start = std::chrono::hours(9);
  PairReader reader(twoLive(color, depth, clock, milliseconds(600)));
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  const auto pair = reader.next().value();
  EXPECT_EQ(slopeNumber(pair->color), 15);
  EXPECT_EQ(slopeNumber(pair->depth), 0);
}

// The colour's connection breaks after a second and is back half a second later; the depth has continued meanwhile.
TEST(PairReader, TwoLiveSourcesMeetAnewAfterTheColourWasAway) {
  ManualClock clock;
  MockMediaProfile color = live(100), depth = live(100);
  color.lose_after_packets = 25;
  PairReader reader(
      {.make_source = [=, &clock, made = 0](
                          const std::string&) mutable { return makeMockSource(made++ == 1 ? depth : color, clock); },
       .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32}); },
       .clock = &clock});
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  Result<std::optional<FramePair>> pair = reader.next();
  MediaTime last;
  for (; pair; pair = reader.next()) last = (*pair)->color.pts;
  ASSERT_TRUE(reader.isSourceLost(pair.error()));
  clock.advance(milliseconds(1600));
  ASSERT_TRUE(reader.reopen().has_value());
  pair = reader.next();
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ((*pair)->color.pts, last + milliseconds(40)) << "the film's time goes on";
  EXPECT_EQ(slopeNumber((*pair)->color), 0);
  ASSERT_FALSE((*pair)->depth.empty());
  EXPECT_EQ(slopeNumber((*pair)->depth), 40) << "1.6 s after the depth's first";
  EXPECT_EQ(reader.counters().reconnects, 1u);
}

// In real time, with the depth's own thread: the depth stalls for an hour, the colour is read to its end, and the film
// can be closed.
TEST(PairReader, DepthThatFallsSilentDoesNotHoldTheColourUp) {
  MonotonicClock clock;
  MockMediaProfile color{.tracks = {MockTrack{.frames = 60}}}, depth = live(60);
  depth.tracks[0].frame_period = color.tracks[0].frame_period;
  depth.stall_after_packets = 20;
  depth.stall = std::chrono::hours(1);
  PairReader reader(
      {.make_source = [=, &clock, made = 0](
                          const std::string&) mutable { return makeMockSource(made++ == 0 ? color : depth, clock); },
       .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 64}); },
       .clock = &clock,
       .own_threads = true});
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 60u);
  for (std::size_t k = 0; k < 19; ++k) EXPECT_EQ(pairs[k].depth.pts, pairs[k].color.pts) << k;
  for (std::size_t k = 25; k < 60; ++k) EXPECT_TRUE(pairs[k].depth.empty()) << k;
  reader.close();
}

TEST(PairReader, DepthOfAThreadOfItsOwnIsPairedLikeAnyOther) {
  MonotonicClock clock;
  MockMediaProfile color{.tracks = {MockTrack{.frames = 200}}}, depth{.tracks = {MockTrack{.frames = 200}}};
  depth.remote = true;
  PairReader reader(
      {.make_source = [=, &clock, made = 0](
                          const std::string&) mutable { return makeMockSource(made++ == 0 ? color : depth, clock); },
       .make_decoder = [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 300}); },
       .clock = &clock,
       .own_threads = true});
  ASSERT_TRUE(reader.open({.url = "color", .depth_url = "depth"}).has_value());
  for (const double target : {0.0, 3.0, 1.0}) {
    ASSERT_TRUE(reader.seek(mediaTime(target)).has_value());
    const auto pairs = readAll(reader);
    EXPECT_NEAR(static_cast<double>(pairs.size()), 200 - 30 * target, 1);
    for (const FramePair& pair : pairs) EXPECT_EQ(pair.depth.pts, pair.color.pts);
  }
  EXPECT_EQ(reader.counters().mismatched, 0u);
}

TEST(PairReader, LostColourIsTheCallersError) {
  MockFilm film;
  film.color.lose_after_packets = 10;
  ASSERT_TRUE(film.reader.open({.url = "color", .depth_url = "depth"}).has_value());
  Result<std::optional<FramePair>> pair;
  int pairs = -1;
  do {
    pair = film.reader.next();
    ++pairs;
  } while (pair);
  EXPECT_EQ(pair.error().code, ErrorCode::Lost);
  EXPECT_EQ(film.reader.failedThing(), "color");
  EXPECT_GE(pairs, 8);
}

TEST(PairReader, InterruptHoldsUntilTheNextOpen) {
  MockFilm film;
  ASSERT_TRUE(film.reader.open({.url = "color", .depth_url = "depth"}).has_value());
  film.reader.interrupt();
  Result<std::optional<FramePair>> pair;
  do pair = film.reader.next();
  while (pair);
  EXPECT_EQ(pair.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(film.reader.seek(MediaTime{}).error().code, ErrorCode::Cancelled);
  film.sources = 0;
  EXPECT_TRUE(film.reader.open({.url = "color", .depth_url = "depth"}).has_value());
  EXPECT_TRUE(film.reader.next().has_value());
}

// Calls `at_read` before each read.
class ToldSource final : public MediaSource {
 public:
  ToldSource(std::unique_ptr<MediaSource> source, std::function<void()> at_read)
      : source_(std::move(source)), at_read_(std::move(at_read)) {}

 private:
  Result<Description> openSource(const std::string& url) override {
    if (auto opened = source_->open(url); !opened) return std::unexpected(opened.error());
    return Description{source_->streams(), source_->tags(), source_->duration()};
  }
  Result<std::optional<Packet>> readPacket() override {
    at_read_();
    return source_->read();
  }
  Result<void> seekTo(MediaTime target) override { return source_->seek(target); }
  void closeSource() noexcept override { source_->close(); }
  void interrupted() noexcept override { source_->interrupt(); }
  std::unique_ptr<MediaSource> source_;
  std::function<void()> at_read_;
};

// A black film of 60 pictures, of which 40 and those that follow are looked at for one that tells something.
TEST(PairReader, AnInterruptEndsTheLookAtLaterPictures) {
  TemporaryFolder folder;
  ClipTrack black = color(30, 60);
  black.sample = [](int, int, int, int) { return 0u; };
  makeClip(folder / "a.mkv", {black});
  PairReader* reading = nullptr;
  int scouted = 0, interrupt_at = 1000;
  const auto atRead = [&] {
    if (++scouted == interrupt_at) reading->interrupt();
  };
  PairReader::Backends backends = kFfmpeg;
  backends.make_source = [&, sources = 0](const std::string&) mutable -> std::unique_ptr<MediaSource> {
    if (sources++ % 2 == 0) return makeFfmpegSource();
    return std::make_unique<ToldSource>(makeFfmpegSource(), atRead);
  };
  PairReader reader(backends);
  reading = &reader;
  ASSERT_TRUE(reader.open({.url = folder / "a.mkv"}).has_value());
  EXPECT_GE(scouted, 40);
  scouted = 0, interrupt_at = 3;
  static_cast<void>(reader.open({.url = folder / "a.mkv"}));
  EXPECT_EQ(scouted, 3);
}

TEST(PairReader, ALiveFilmThatCannotSeekGoesOnWhereItWas) {
  MockFilm film;
  film.color.live = true;
  ASSERT_TRUE(film.reader.open({.url = "color"}).has_value());
  const MediaTime first = film.reader.next().value()->color.pts;
  const auto sought = film.reader.seek(MediaTime{});
  ASSERT_FALSE(sought.has_value());
  EXPECT_EQ(sought.error().code, ErrorCode::Unsupported);
  EXPECT_EQ(film.reader.next().value()->color.pts, first + film.color.tracks[0].frame_period);
}

TEST(PairReader, VerbsWithoutAFilmAreRefused) {
  PairReader reader(kFfmpeg);
  EXPECT_EQ(reader.next().error().code, ErrorCode::InvalidState);
  EXPECT_EQ(reader.seek(MediaTime{}).error().code, ErrorCode::InvalidState);
  reader.interrupt();
  reader.close();
}

// ---- real depth video

std::string data(const std::string& name) {
  return std::string(RELIEVO_TEST_DATA) + "/" + name;
}
#define RELIEVO_NEEDS(file) \
  if (!std::filesystem::exists(data(file))) GTEST_SKIP() << data(file) << " is not here"

TEST(PairReaderRealVideo, CupIsPairedToTheEnd) {
  RELIEVO_NEEDS("cup/color_output.webm");
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(
      reader.open({.url = data("cup/color_output.webm"), .depth_url = data("cup/depth_output.webm")}).has_value());
  EXPECT_EQ(reader.info().color_width, 512);
  EXPECT_EQ(reader.info().color_height, 512);
  EXPECT_EQ(reader.info().depth_width, 288);
  EXPECT_EQ(reader.info().depth_height, 512);
  EXPECT_EQ(reader.info().calibration.calibration.range, ColorRange::Limited);
  std::uint64_t pairs = 0;
  while (const auto pair = reader.next().value()) {
    ++pairs;
    ASSERT_FALSE(pair->depth.empty());
    ASSERT_EQ(pair->depth.pts, pair->color.pts);
  }
  EXPECT_EQ(pairs, 581u);
  EXPECT_EQ(reader.counters().pairs, 581u);
  EXPECT_EQ(reader.counters().mismatched, 0u);
  EXPECT_EQ(reader.counters().depth_skipped, 0u);
  EXPECT_EQ(reader.counters().damaged, 0u);
}

TEST(PairReaderRealVideo, DeskIsColourOnTopAndHueBelow) {
  RELIEVO_NEEDS("desk/Test.mov");
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = data("desk/Test.mov"), .packing = Packing::TopBottom, .depth_code = DepthCode::Hue})
                  .has_value());
  EXPECT_EQ(reader.info().color_width, 512);
  EXPECT_EQ(reader.info().color_height, 424);
  EXPECT_EQ(reader.info().depth_height, 424);
  EXPECT_EQ(reader.info().color_codec, "hap");
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 48u);
  EXPECT_EQ(pairs[0].depth.model, ColorModel::Rgb);
  EXPECT_EQ(pairs[47].color.pts, mediaTime(47.0 / 24));
  // Two thirds of the depth have no reading and are black; the colour has no such areas.
  int black = 0;
  for (int r = 0; r < 424; ++r) {
    for (int c = 0; c < 512; ++c) {
      const Frame& d = pairs[20].depth;
      if (sampleAt(d, 0, c, r) + sampleAt(d, 1, c, r) + sampleAt(d, 2, c, r) <= 229) ++black;
    }
  }
  EXPECT_NEAR(black / (512.0 * 424.0), 0.67, 0.05);
}

TEST(PairReaderRealVideo, DeskIsKnownByItsHalves) {
  RELIEVO_NEEDS("desk/Test.mov");
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = data("desk/Test.mov")}).has_value());
  EXPECT_EQ(reader.info().packing, Packing::TopBottom);
  EXPECT_EQ(reader.info().calibration.calibration.code, DepthCode::Hue);
  EXPECT_EQ(reader.info().color_height, 424);
}

// The expected samples were read with another decoder.
TEST(PairReaderRealVideo, SixteenBitSurveysAreReadToTheBit) {
  RELIEVO_NEEDS("dome/02.png");
  PairReader reader(kFfmpeg);
  ASSERT_TRUE(reader.open({.url = data("dome/%02d.png"), .depth_url = data("dome/%02d.png")}).has_value());
  EXPECT_EQ(reader.info().depth_width, 303);
  EXPECT_EQ(reader.info().calibration.calibration.bits, 16);
  EXPECT_EQ(reader.info().calibration.calibration.range, ColorRange::Full);
  const auto pairs = readAll(reader);
  ASSERT_EQ(pairs.size(), 13u);
  for (const FramePair* pair : {&pairs.front(), &pairs.back()}) {  // the ground outside the crater does not move
    EXPECT_EQ(sampleAt(pair->depth, 0, 10, 20), 14323u);
    EXPECT_EQ(sampleAt(pair->depth, 0, 150, 221), 17876u);
    EXPECT_EQ(sampleAt(pair->depth, 0, 302, 441), 18490u);
  }
}

}  // namespace
}  // namespace relievo
