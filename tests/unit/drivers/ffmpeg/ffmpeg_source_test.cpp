// SPDX-License-Identifier: Apache-2.0
// The FFmpeg source: streams, times from zero, seeks.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "drivers/ffmpeg/ffmpeg.h"
#include "platform/files/file_system_answer.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/mkv_patch.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;

MediaTime nominal(int frame, int fps) {
  return MediaTime(Duration(std::int64_t{1'000'000'000} * frame / fps));
}

TEST(FfmpegSource, DescribesItsStreams) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv",
           {ClipTrack{.codec = "libx264", .pix_fmt = "yuv420p", .width = 66, .height = 50, .fps_num = 24, .frames = 48},
            ClipTrack{.fps_num = 24, .frames = 48, .tags = {{"title", "Depth"}, {"depth_near", "500"}}}},
           {{"Depth_Law", "inverse"}});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.mkv").has_value());
  EXPECT_EQ(source->tags().at("DEPTH_LAW"), "inverse");
  EXPECT_NEAR(toSeconds(source->duration()), 2.0, 0.001);
  ASSERT_EQ(source->streams().size(), 2u);
  const StreamInfo& color = source->streams()[0];
  const StreamInfo& depth = source->streams()[1];
  EXPECT_EQ(color.kind, StreamKind::Video);
  EXPECT_EQ(color.codec, "h264");
  EXPECT_EQ(color.width, 66);
  EXPECT_EQ(color.height, 50);
  EXPECT_FALSE(color.extradata.empty());
  EXPECT_NEAR(toSeconds(color.frame_period), 1.0 / 24, 1e-6);
  EXPECT_EQ(depth.codec, "ffv1");
  EXPECT_EQ(depth.tags.at("TITLE"), "Depth");
  EXPECT_EQ(depth.tags.at("DEPTH_NEAR"), "500");
  source->close();
  EXPECT_TRUE(source->streams().empty());
}

TEST(FfmpegSource, CoverPicturesAreNoVideoStreams) {
  TemporaryFolder folder;
  makeClip(folder / "a.mp4", {kH264, ClipTrack{.codec = "png", .pix_fmt = "rgb24", .frames = 1, .cover = true}});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.mp4").has_value());
  ASSERT_EQ(source->streams().size(), 2u);
  EXPECT_EQ(source->streams()[0].kind, StreamKind::Video);
  EXPECT_EQ(source->streams()[1].kind, StreamKind::Other);
}

// An adaptive stream offers one film at several rates: the second is not a second track of it.
TEST(FfmpegSource, OfSeveralProgrammesTheBestIsTheFilm) {
  TemporaryFolder folder;
  ClipTrack small = kH264;
  small.width = 32, small.height = 24;
  makeClip(folder / "small.ts", {small});
  makeClip(folder / "large.ts", {kH264});
  const std::string head = "#EXTM3U\n#EXT-X-VERSION:3\n#EXT-X-TARGETDURATION:2\n#EXTINF:1.6,\n";
  writeFile(folder / "small.m3u8", head + "small.ts\n#EXT-X-ENDLIST\n");
  writeFile(folder / "large.m3u8", head + "large.ts\n#EXT-X-ENDLIST\n");
  writeFile(folder / "film.m3u8",
            "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=100000,RESOLUTION=32x24\nsmall.m3u8\n"
            "#EXT-X-STREAM-INF:BANDWIDTH=900000,RESOLUTION=64x48\nlarge.m3u8\n");
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "film.m3u8").has_value());
  ASSERT_EQ(source->streams().size(), 2u);
  int film = -1;
  for (const StreamInfo& stream : source->streams()) {
    if (stream.kind == StreamKind::Video) {
      EXPECT_EQ(film, -1) << "two films";
      film = stream.index;
      EXPECT_EQ(stream.width, 64);
    }
  }
  const auto packets = readAll(*source);
  EXPECT_EQ(packets.size(), 48u);
  for (const Packet& packet : packets) EXPECT_EQ(packet.stream, film);
}

TEST(FfmpegSource, OfSeveralProgrammesTheFilmBeginsByItsOwnClock) {
  if (std::system("command -v ffmpeg >/dev/null") != 0) GTEST_SKIP() << "no ffmpeg program here";
  TemporaryFolder folder;
  for (const char* hour : {"-itsoffset 3600 ", ""}) {  // of the larger picture, or of the other one
    const std::string other = *hour == 0 ? "-itsoffset 3600 " : "";
    const std::string make = "ffmpeg -v error -y " + other + "-f lavfi -i testsrc=s=64x48:r=25:d=1 " + hour +
                             "-f lavfi -i testsrc2=s=128x96:r=25:d=1 -map 0 -map 1 -c:v libx264 -bf 0"
                             " -program program_num=1:st=0 -program program_num=2:st=1 " +
                             folder / "two.ts";
    ASSERT_EQ(std::system(make.c_str()), 0);
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / "two.ts").has_value());
    EXPECT_NEAR(toSeconds(source->duration()), 1, 0.05);
    const auto packets = readAll(*source);
    ASSERT_EQ(packets.size(), 25u) << other;
    EXPECT_EQ(packets.front().pts, MediaTime{}) << other;
    ASSERT_TRUE(source->seek(MediaTime{}).has_value());
    EXPECT_EQ(readAll(*source).front().pts, MediaTime{}) << other;
  }
}

// That of a picture of a folder reads through a source that nobody else knows.
TEST(FfmpegSource, ALookEndsWhenItsFilmIsLeft) {
  const TemporaryFolder folder;
  makeClip(folder / "film.mkv", {kH264});
  std::atomic<bool> left{false};
  const CancelsAnswers cancels(left);
  EXPECT_TRUE(makeFfmpegSource()->open(folder / "film.mkv"));
  left = true;
  EXPECT_FALSE(makeFfmpegSource()->open(folder / "film.mkv"));
}

struct Container {
  const char* file;
  Duration exactness;
};
void PrintTo(const Container& container, std::ostream* out) {
  *out << container.file;
}
class Containers : public testing::TestWithParam<Container> {};

TEST_P(Containers, TimesBeginAtZeroWhateverTheContainerStartsWith) {
  TemporaryFolder folder;
  const std::string path = folder / GetParam().file;
  makeClip(path, {ClipTrack{.codec = "libx264",
                            .pix_fmt = "yuv420p",
                            .frames = 48,
                            .start = std::chrono::milliseconds(1500),
                            .b_frames = 2}});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(path).has_value());
  std::vector<MediaTime> times;
  for (const Packet& packet : readAll(*source)) times.push_back(packet.pts.value());
  std::sort(times.begin(), times.end());
  ASSERT_EQ(times.size(), 48u);
  EXPECT_EQ(times[0], MediaTime{});
  for (int k = 0; k < 48; ++k) {
    EXPECT_LE(std::chrono::abs(times[static_cast<std::size_t>(k)] - nominal(k, 30)), GetParam().exactness) << k;
  }
}

// Matroska rounds to milliseconds, the start as well as the time itself; the others count in 1/90000 s.
INSTANTIATE_TEST_SUITE_P(Ffmpeg, Containers,
                         testing::Values(Container{"a.mkv", std::chrono::milliseconds(1)},
                                         Container{"a.mp4", Duration(1)}, Container{"a.ts", Duration(1)}));

// The start of a container is kept in microseconds; 33.366667 ms are not a whole number of them.
TEST(FfmpegSource, TheFirstTimeIsZeroToTheNanosecond) {
  TemporaryFolder folder;
  makeClip(folder / "a.ts", {ClipTrack{.codec = "libx264",
                                       .pix_fmt = "yuv420p",
                                       .fps_num = 30000,
                                       .fps_den = 1001,
                                       .frames = 10,
                                       .start = Duration(33'366'667)}});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.ts").has_value());
  EXPECT_EQ(source->read().value()->pts, MediaTime{});
}

TEST(FfmpegSource, TracksKeepTheirDistanceFromTheFilmsZero) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {ClipTrack{.frames = 3}, ClipTrack{.frames = 3, .start = std::chrono::milliseconds(40)}});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.mkv").has_value());
  for (const Packet& packet : readAll(*source)) {
    if (packet.stream == 1) {
      EXPECT_EQ(packet.pts, mediaTime(0.040));
      break;
    }
  }
}

TEST(FfmpegSource, SeeksToTheKeyFrameAtOrBefore) {
  TemporaryFolder folder;
  ClipTrack track = kH264;
  track.gop = 12;
  track.fps_num = 25;
  track.start = std::chrono::milliseconds(1500);
  makeClip(folder / "a.mkv", {track});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.mkv").has_value());
  for (const int frame : {30, 11, 12, 47, 0, 24}) {
    ASSERT_TRUE(source->seek(nominal(frame, 25)).has_value());
    const auto packet = source->read().value();
    ASSERT_TRUE(packet.has_value());
    EXPECT_TRUE(packet->keyframe);
    EXPECT_EQ(packet->pts, nominal(frame / 12 * 12, 25)) << frame;
  }
  readAll(*source);
  EXPECT_EQ(source->state(), MediaSource::State::Ended);
  ASSERT_TRUE(source->seek(MediaTime{}).has_value());
  EXPECT_EQ(readAll(*source).size(), 48u);
}

// The leading track has no packet at or before the target: the seek lands on its first one.
TEST(FfmpegSource, SeeksWhereTheLeadingTrackHasNotBegun) {
  TemporaryFolder folder;
  ClipTrack late = kH264;
  late.start = std::chrono::seconds(1);
  for (const char* name : {"a.mp4", "a.mkv", "a.avi"}) {
    makeClip(folder / name, {late, kH264});
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value());
    const auto count = readAll(*source).size();
    ASSERT_TRUE(source->seek(MediaTime{}).has_value()) << name;
    EXPECT_EQ(readAll(*source).size(), count) << name;
    ASSERT_TRUE(source->seek(mediaTime(0.5)).has_value()) << name;
    EXPECT_GE(readAll(*source).size(), 48u) << name;
  }
}

// An adaptive stream rejects seeks near its end.
TEST(FfmpegSource, ASeekBeyondTheEndLandsNearTheEnd) {
  TemporaryFolder folder;
  ClipTrack track = kH264;
  track.frames = 180;
  for (const char* name : {"a.m3u8", "a.mp4", "a.mkv", "a.ts"}) {
    makeClip(folder / name, {track});
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value());
    for (const double target : {5.99, 60.0}) {
      ASSERT_TRUE(source->seek(mediaTime(target)).has_value()) << name;
      const auto packets = readAll(*source);
      const MediaTime landed = packets.empty() ? mediaTime(6) : packets[0].pts.value();
      EXPECT_GE(landed, mediaTime(3.9)) << name << " " << target;
    }
  }
}

TEST(FfmpegSource, WhatHasNoTimesSeeksToItsBeginning) {
  TemporaryFolder folder;
  makeClip(folder / "%02d.png", {ClipTrack{.codec = "png", .pix_fmt = "gray", .frames = 4}});
  makeClip(folder / "one.png", {ClipTrack{.codec = "png", .pix_fmt = "gray", .frames = 1}});
  for (const auto& [name, count] : {std::pair{"%02d.png", 4u}, std::pair{"one.png", 1u}}) {
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value());
    EXPECT_EQ(readAll(*source).size(), count);
    ASSERT_TRUE(source->seek(mediaTime(0.08)).has_value());
    EXPECT_EQ(readAll(*source).size(), count);
  }
}

}  // namespace
}  // namespace relievo
