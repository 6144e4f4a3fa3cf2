// SPDX-License-Identifier: Apache-2.0
// Films with a hole in the middle: of bytes, or of a segment that is gone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

extern "C" {
#include <libavformat/avformat.h>
}

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/network_error.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using ffmpeg::LibraryWords;
using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

const ClipTrack kTwoSeconds{.codec = "libx264", .pix_fmt = "yuv420p", .fps_num = 24, .frames = 48};

// FFmpeg passes over a segment that it cannot open.
TEST(FfmpegSource, TellsThatAPartOfAListIsGone) {
  TemporaryFolder folder;
  makeClip(folder / "a.ts", {kTwoSeconds});
  std::filesystem::copy_file(folder / "a.ts", folder / "b.ts");
  writeFile(folder / "list.m3u8",
            "#EXTM3U\n#EXT-X-TARGETDURATION:2\n#EXTINF:2,\na.ts\n#EXTINF:2,\ngone.ts\n#EXT-X-DISCONTINUITY\n#EXTINF:2,"
            "\nb.ts\n"
            "#EXT-X-ENDLIST\n");
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "list.m3u8").has_value());
  testing::internal::CaptureStderr();
  EXPECT_EQ(readAll(*source).size(), 96U);
  EXPECT_NEAR(toSeconds(source->missing()), 2, 0.1);
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_THAT(told, HasSubstr("list.m3u8: its part file:" + folder / "gone.ts"));
  EXPECT_EQ(std::ranges::count(told, '\n'), 1) << "told once: " << told;
}

TEST(FfmpegSource, TellsThatNoPartOfAListIsThere) {
  TemporaryFolder folder;
  writeFile(folder / "list.m3u8",
            "#EXTM3U\n#EXT-X-TARGETDURATION:2\n#EXTINF:2,\ngone.ts\n#EXTINF:2,\naway.ts\n#EXT-X-ENDLIST\n");
  writeFile(folder / "lists.m3u8", "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=100000\nlist.m3u8\n");
  for (const char* list : {"list.m3u8", "lists.m3u8"}) {
    testing::internal::CaptureStderr();
    EXPECT_THAT(openErrorOf(folder / list).message, HasSubstr("none of its parts can be opened")) << list;
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("gone.ts, cannot be opened")) << list;
  }
}

// The error is then that of the part that is there.
TEST(FfmpegSource, AListWithAPartThatIsNoFilmIsNotToldToHaveNoParts) {
  TemporaryFolder folder;
  writeFile(folder / "text.ts", std::string(20000, 'x'));
  for (const char* parts : {"gone.ts\n#EXTINF:2,\ntext.ts", "text.ts\n#EXTINF:2,\ngone.ts"}) {
    writeFile(folder / "list.m3u8",
              "#EXTM3U\n#EXT-X-TARGETDURATION:2\n#EXTINF:2,\n" + std::string(parts) + "\n#EXT-X-ENDLIST\n");
    testing::internal::CaptureStderr();
    EXPECT_THAT(openErrorOf(folder / "list.m3u8").message, Not(HasSubstr("none of its parts"))) << parts;
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("gone.ts cannot be opened")) << parts;
  }
}

// Within FFmpeg, until no descriptor is left.
TEST(FfmpegSource, AListThatNamesItselfIsToldToBeOne) {
  TemporaryFolder folder;
  writeFile(folder / "a.ffconcat", "ffconcat version 1.0\nfile a.ffconcat\n");
  rlimit usual{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &usual), 0);
  rlimit few = usual;
  few.rlim_cur = 64;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  const Error error = openErrorOf(folder / "a.ffconcat");
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &usual), 0);
  EXPECT_THAT(error.message, HasSubstr("a list that names itself"));
}

// The second half begins at the first one's time.
TEST(FfmpegSource, AListWhoseTimesBeginAgainIsWhole) {
  TemporaryFolder folder;
  makeClip(folder / "a.ts", {kTwoSeconds});
  writeFile(folder / "list.m3u8",
            "#EXTM3U\n#EXT-X-TARGETDURATION:2\n#EXTINF:2,\na.ts\n#EXT-X-DISCONTINUITY\n#EXTINF:2,\na.ts\n"
            "#EXT-X-ENDLIST\n");
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "list.m3u8").has_value());
  EXPECT_EQ(readAll(*source).size(), 96U);
  EXPECT_EQ(source->missing(), Duration(0));
  ASSERT_TRUE(source->seek(mediaTime(3)).has_value());
  readAll(*source);
  EXPECT_EQ(source->missing(), Duration(0));
}

// The packets behind the hole do not count on from those before it.
TEST(FfmpegSource, TellsAHoleInATransportStream) {
  TemporaryFolder folder;
  makeClip(folder / "a.ts",
           {{.codec = "mpeg2video", .pix_fmt = "yuv420p", .width = 320, .height = 240, .fps_num = 24, .frames = 48}});
  std::ifstream file(folder / "a.ts", std::ios::binary);
  std::string film{std::istreambuf_iterator<char>(file), {}};
  const std::size_t packets = film.size() / 188;
  writeFile(folder / "a.ts", film.erase(packets * 2 / 5 * 188, (packets / 3 / 16 * 16 + 3) * 188));
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.ts").has_value());
  testing::internal::CaptureStderr();
  const double there = static_cast<double>(readAll(*source).size()) / 24;
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("are missing: a part of it cannot be read"));
  EXPECT_NEAR(toSeconds(source->missing()), 2 - there, 0.1);
}

// A fifth of the bytes is taken out. What FFmpeg says of it is its own business; that it warns, and the times, tell it.
TEST(FfmpegSource, TellsAHoleInEveryContainer) {
  TemporaryFolder folder;
  const std::string make =
      "cd '" + folder / "" +
      "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=96x64:r=25:d=10 -f lavfi -i sine=d=10 "
      "-map 0 -c:v libx264 -g 25 a.mkv -map 0 -c:v libx264 -g 25 a.flv -map 0 -map 1 -c:v libx264 "
      "-c:a aac a.nut -map 0 -c:v libtheora a.ogv -map 0 -c:v libvpx a.webm -map 0 -c:v wmv2 a.wmv";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  for (const char* name : {"a.mkv", "a.flv", "a.nut", "a.ogv", "a.webm", "a.wmv"}) {
    std::ifstream file(folder / name, std::ios::binary);
    std::string film{std::istreambuf_iterator<char>(file), {}};
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    readAll(*source);
    EXPECT_EQ(source->missing(), Duration(0)) << name << " is whole";
    source->close();
    writeFile(folder / name, film.erase(film.size() * 2 / 5, film.size() / 5));
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    const double there = static_cast<double>(std::ranges::count(readAll(*source), 0, &Packet::stream)) / 25;
    EXPECT_LT(there, 9) << name;
    EXPECT_GT(toSeconds(source->missing()), 1) << name;
    EXPECT_LT(toSeconds(source->missing()), 10.1 - there) << name;
  }
}

// Between two whole clusters. It may be a still, so that it is no part that is known to be missing.
TEST(FfmpegSource, TellsALongTimeWithoutAPictureAtASteadyRate) {
  TemporaryFolder folder;
  const std::string make = "cd '" + folder / "" +
                           "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=64x48:r=10:d=10 -c:v libx264 -g 10 "
                           "-cluster_time_limit 1000 a.mkv";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  std::ifstream file(folder / "a.mkv", std::ios::binary);
  std::string film{std::istreambuf_iterator<char>(file), {}};
  const std::string cluster = "\x1f\x43\xb6\x75";
  std::vector<std::size_t> begins;
  for (auto at = film.find(cluster); at != std::string::npos; at = film.find(cluster, at + 1)) begins.push_back(at);
  ASSERT_GE(begins.size(), 9U);
  writeFile(folder / "a.mkv", film.erase(begins[4], begins[6] - begins[4]));
  const auto source = makeFfmpegSource();
  testing::internal::CaptureStderr();
  ASSERT_TRUE(source->open(folder / "a.mkv").has_value());
  EXPECT_NEAR(static_cast<double>(readAll(*source).size()), 80, 10) << "clusters of about 1 s";
  EXPECT_EQ(source->missing(), Duration(0));
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_THAT(told, testing::EndsWith("s there are no pictures: a still, or a part is missing\n"));
  EXPECT_EQ(std::ranges::count(told, '\n'), 1) << told;
}

// Three segments of 1 s, the second of which is gone. FFmpeg 7.1 opens segments by the callback that is told of them,
// 5.1 by itself: then the gap is told.
TEST(FfmpegSource, TellsThatASegmentOfADashFilmIsGone) {
  TemporaryFolder folder;
  const std::string make = "cd '" + folder / "" +
                           "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=64x48:r=10:d=3 -c:v libx264 -g 10 "
                           "-seg_duration 1 -f dash a.mpd";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  for (const std::size_t pictures : {30U, 20U}) {
    if (pictures < 30) std::filesystem::remove(folder / "chunk-stream0-00002.m4s");
    const auto source = makeFfmpegSource();
    testing::internal::CaptureStderr();
    ASSERT_TRUE(source->open(folder / "a.mpd").has_value());
    EXPECT_EQ(readAll(*source).size(), pictures);
    EXPECT_NEAR(toSeconds(source->missing()), pictures < 30 ? 1 : 0, 0.05);
    ASSERT_TRUE(source->seek(mediaTime(2.5)).has_value());
    readAll(*source);
    const std::string told = testing::internal::GetCapturedStderr();
    if (pictures == 30) EXPECT_EQ(told, "");
    else
      EXPECT_THAT(told, AnyOf(HasSubstr("chunk-stream0-00002.m4s cannot be opened and is left out\n"),
                              HasSubstr("a.mpd: 1.0 s at 0.8 s are missing: a part of it cannot be read\n")));
  }
}

// One of three segments of 1 s, whose times continue. The first ones are read while the film is opened.
TEST(FfmpegSource, TellsTheLossOfASegmentOfAnHlsFilmOnce) {
  TemporaryFolder folder;
  const std::string make = "cd '" + folder / "" +
                           "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=64x48:r=10:d=3 -c:v libx264 -g 10 "
                           "-hls_time 1 -hls_playlist_type vod a.m3u8";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  for (const char* segment : {"a0.ts", "a1.ts", "a2.ts"}) {
    std::filesystem::rename(folder / segment, folder / "away");
    const auto source = makeFfmpegSource();
    testing::internal::CaptureStderr();
    ASSERT_TRUE(source->open(folder / "a.m3u8").has_value()) << segment;
    EXPECT_EQ(readAll(*source).size(), 20U) << segment;
    EXPECT_NEAR(toSeconds(source->missing()), 1, 0.05) << segment;
    const std::string told = testing::internal::GetCapturedStderr();
    EXPECT_THAT(told, HasSubstr(std::string(segment) + " cannot be opened"));
    EXPECT_EQ(std::ranges::count(told, '\n'), 1) << told;
    std::filesystem::rename(folder / "away", folder / segment);
  }
}

// The first or the second of seven segments is gone. Later a picture stands for 1.5 s.
TEST(FfmpegSource, ALostSegmentExplainsOneGapAlone) {
  TemporaryFolder folder;
  const std::string make =
      "cd '" + folder / "" +
      "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=64x48:r=10:d=8 -vf \"select='not(between(n,42,56))'\" "
      "-vsync vfr -c:v libx264 -g 10 -hls_time 1 -hls_list_size 0 -hls_playlist_type vod a.m3u8";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  for (const std::string segment : {"a0.ts", "a1.ts"}) {
    std::filesystem::rename(folder / segment, folder / "away");
    const auto source = makeFfmpegSource();
    testing::internal::CaptureStderr();
    ASSERT_TRUE(source->open(folder / "a.m3u8").has_value()) << segment;
    EXPECT_EQ(readAll(*source).size(), 55U) << segment;
    const std::string told = testing::internal::GetCapturedStderr();
    EXPECT_THAT(told, HasSubstr(segment + " cannot be opened"));
    EXPECT_THAT(told, HasSubstr(segment == "a0.ts" ? "for 1.5 s at 3.2 s there are" : "for 1.5 s at 4.2 s there are"));
    EXPECT_NEAR(toSeconds(source->missing()), 1, 0.05) << segment;
    std::filesystem::rename(folder / "away", folder / segment);
  }
}

// A picture that stands for 1.5 s is told by the next one's time alone.
TEST(FfmpegSource, ASegmentedFilmWhosePicturesLastLongIsWhole) {
  TemporaryFolder folder;
  const std::string make =
      "cd '" + folder / "" +
      "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=64x48:r=10:d=4 -vf "
      "\"select='not(between(n,12,26))'\" -vsync vfr -c:v libx264 -g 10 a.mkv && ffmpeg -nostdin -v "
      "error -i a.mkv -c copy -f dash a.mpd -c copy -hls_playlist_type vod a.m3u8";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  for (const char* name : {"a.mpd", "a.m3u8"}) {
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    EXPECT_EQ(readAll(*source).size(), 25U) << name;
    EXPECT_EQ(source->missing(), Duration(0)) << name;
  }
}

TEST(LibraryWords, WhatFfmpegSaysOfWholeFilmsIsNoDamage) {
  const std::unique_ptr<AVFormatContext, void (*)(AVFormatContext*)> container(avformat_alloc_context(),
                                                                               avformat_free_context);
  LibraryWords words;
  words.listenTo(*container);
  av_log(container.get(), AV_LOG_WARNING, "Could not find codec parameters for stream %d (Subtitle)\n", 2);
  EXPECT_FALSE(words.containerWarned());
  av_log(container.get(), AV_LOG_WARNING, "%s\n", "a part was passed over");
  EXPECT_TRUE(words.containerWarned());
}

}  // namespace
}  // namespace relievo
