// SPDX-License-Identifier: Apache-2.0
// The FFmpeg source: times from zero, tags, seeks, clear errors, broken files, interruption.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <thread>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/refusal.h"
#include "drivers/ffmpeg/watch.h"
#include "platform/unique_fd.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/mkv_patch.h"
#include "tests/support/film/ts_patch.h"
#include "tests/support/network/http_server.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;
using testing::HasSubstr;

const ClipTrack kH264{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 48};

Error openErrorOf(const std::string& url) {
  const auto source = makeFfmpegSource();
  const auto opened = source->open(url);
  EXPECT_FALSE(opened.has_value()) << url;
  EXPECT_EQ(source->state(), MediaSource::State::Closed);
  return opened ? Error{} : opened.error();
}

std::vector<Packet> readAll(MediaSource& source) {
  std::vector<Packet> packets;
  while (auto packet = source.read().value()) packets.push_back(*packet);
  return packets;
}

MediaTime nominal(int frame, int fps) {
  return MediaTime(Duration(std::int64_t{1'000'000'000} * frame / fps));
}

void writeFile(const std::string& path, std::string_view content) {
  std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
}

void cutFile(const std::string& path, double part) {
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  std::filesystem::resize_file(path, static_cast<std::uintmax_t>(size * part));
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

TEST(FfmpegSource, AFileIsAFileWhateverItsNameLooksLike) {
  TemporaryFolder folder;
  makeClip(folder / "plain.mkv", {ClipTrack{.frames = 2}});
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  std::filesystem::rename("plain.mkv", "rtsp:12:30.mkv");
  const auto source = makeFfmpegSource();
  EXPECT_TRUE(source->open("rtsp:12:30.mkv").has_value());
  std::filesystem::current_path(before);
}

TEST(FfmpegSource, SaysWhatIsWrongWithWhatItCannotOpen) {
  TemporaryFolder folder;
  EXPECT_EQ(openErrorOf(folder / "none.mkv").code, ErrorCode::NotFound);
  EXPECT_THAT(openErrorOf(folder / "none.mkv").message, HasSubstr("no such file"));
  EXPECT_EQ(openErrorOf(folder / "").code, ErrorCode::Unsupported);
  EXPECT_EQ(openErrorOf("nonsense://x/y").code, ErrorCode::Unsupported);

  writeFile(folder / "text.mkv", "this is not a film\n");
  std::string letters;
  for (int i = 0; i < 3000; ++i) letters += "nor is this, though FFmpeg would show its letters\n";
  writeFile(folder / "text.txt", letters);
  writeFile(folder / "empty.mkv", "");
  makeClip(folder / "no-index.mov", {kH264});
  cutFile(folder / "no-index.mov", 0.5);  // the index stands at the end
  for (const char* name : {"text.mkv", "text.txt", "empty.mkv", "no-index.mov"}) {
    EXPECT_EQ(openErrorOf(folder / name).code, ErrorCode::Corrupt) << name;
    EXPECT_THAT(openErrorOf(folder / name).message, HasSubstr("not a media file")) << name;
  }
}

// Told by their first bytes, even where FFmpeg would find something like sound in what follows.
TEST(FfmpegSource, RecordingsThatNothingReadsAreNamedWithTheCommandThatConvertsThem) {
  const TemporaryFolder folder;
  using namespace std::string_view_literals;
  const struct {
    const char* name;
    std::string_view begin;
    std::vector<const char*> words;
  } kFormats[] = {
      {"a.db3", "SQLite format 3\0"sv, {"ROS 2 bag", "rosbags-convert --src FOLDER --dst film.bag"}},
      {"a.mcap", "\x89MCAP0\r\n"sv, {"MCAP", "rosbags-convert --src FOLDER --dst film.bag"}},
      {"a.h5", "\x89HDF\r\n\x1a\n"sv, {"HDF5", ".npy", "h5py.File"}},
      {"a.bag", "#ROSBAG V2.0\n"sv, {"ROS bag", "RELIEVO_ROSBAG"}},
      {"a.oni", "NI10\1"sv, {"OpenNI", "RELIEVO_OPENNI"}},
      {"a.klg", "\6\0\0\0"sv, {"scan", "RELIEVO_SCAN"}},
      {"a.r3d", "PK\3\4"sv, {"Record3D", "EXR"}},
      {"a.npz", "PK\3\4"sv, {"unzip", ".npy"}},
      {"a.zip", "PK\3\4"sv, {"unpack", "folder"}},
      {"a.svo2", "\x89MCAP0\r\n"sv, {"ZED", "ZED_SVO_Export"}},
      {"a.ply", "ply\nformat"sv, {"cloud of points", "recording"}},
      {"a.pcd", "# .PCD v0.7"sv, {"cloud of points", "recording"}},
      {"a.mat", "MATLAB 5.0 MAT-file"sv, {"MATLAB", ".npy", "loadmat"}},
      {"a.raw", "\1\2"sv, {"tell no size", "gray16le"}},
      {"a.bin", "\1\2"sv, {"tell no size", "gray16le"}},
      {"a.yuv", "\1\2"sv, {"tell no size", "yuv420p"}},
      {"a.csv", "1.2,1.3\n"sv, {"table", "numpy.loadtxt"}},
      {"a.pth", "PK\3\4"sv, {"PyTorch", "torch.load"}},
      {"a.yml", "%YAML:1.0"sv, {"OpenCV", "FileStorage"}},
      {"a.gz", "\x1f\x8b"sv, {"unpack"}},
  };
  for (const auto& format : kFormats) {
    writeFile(folder / format.name, std::string(format.begin) + std::string(5000, '\x47'));
    const Error error = openErrorOf(folder / format.name);
    EXPECT_EQ(error.code, ErrorCode::Unsupported) << format.name;
    for (const char* const word : format.words) EXPECT_THAT(error.message, HasSubstr(word));
  }
}

TEST(FfmpegSource, AHeicPhotoItCannotReadIsSaidToBeOne) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "portrait.heic";
  std::ofstream(path, std::ios::binary) << std::string(
      "\0\0\0\x18"
      "ftypheic\0\0\0\0mif1heic",
      24);
  const auto opened = makeFfmpegSource()->open(path);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  for (const char* word : {"HEIC", "libheif", "JPEG"})
    EXPECT_NE(std::string(opened.error().message).find(word), std::string::npos) << opened.error().message;
}

TEST(FfmpegSource, AFileThatMayNotBeReadIsSaidToBe) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {ClipTrack{.frames = 1}});
  std::filesystem::permissions(folder / "a.mkv", std::filesystem::perms::none);
  if (::access((folder / "a.mkv").c_str(), R_OK) == 0) GTEST_SKIP() << "this user may read everything";
  EXPECT_EQ(openErrorOf(folder / "a.mkv").code, ErrorCode::PermissionDenied);
}

// A read of these may block forever: /proc/kmsg would hold a player until the kernel logs something.
TEST(FfmpegSource, WhatIsNoFileIsRefusedBeforeItIsRead) {
  for (const char* path : {"/dev/zero", "/dev/ptmx", "/proc/kmsg", "/proc/self/status", "/sys/kernel/uevent_seqnum"}) {
    for (const std::string start : {"", "file:"}) {
      if (::access(path, F_OK) != 0) continue;
      const Error error = openErrorOf(start + path);
      EXPECT_EQ(error.code, ErrorCode::Unsupported) << start << path;
      EXPECT_THAT(error.message, testing::HasSubstr("a device or a file of the kernel")) << start << path;
    }
  }
}

// FFmpeg determines a PNG's size by decoding the first picture; it must not do so for a picture that is too large.
TEST(FfmpegSource, APictureThatIsTooLargeIsNotDecodedToKnowItsSize) {
  TemporaryFolder folder;
  makeClip(folder / "a.png", {{.codec = "png", .pix_fmt = "gray", .width = 8192, .height = 4096, .frames = 1}});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.png"));
  EXPECT_EQ(source->streams()[0].width, 0);
  makeClip(folder / "b.png", {{.codec = "png", .pix_fmt = "gray", .width = 4096, .height = 4096, .frames = 1}});
  const auto fits = makeFfmpegSource();
  ASSERT_TRUE(fits->open(folder / "b.png"));
  EXPECT_EQ(fits->streams()[0].width, 4096);
}

TEST(FfmpegWatch, WhatIsLateIsSaidOfAFileAPipeAndANetwork) {
  using namespace ffmpeg;
  const auto said = [](const Error& late) {
    Watch watch;
    watch.begin(Duration(0), late);
    EXPECT_TRUE(watch.givesUp());
    return std::string(watch.explain({}).message);
  };
  for (const auto& late : {lateOpening, lateReading}) {
    EXPECT_THAT(said(late(Way::Http)), testing::HasSubstr("check the network"));
    for (const Way way : {Way::File, Way::Pipe}) {
      EXPECT_THAT(said(late(way)), testing::HasSubstr(late == lateOpening ? "30 s" : "10 s"));
      EXPECT_THAT(said(late(way)), testing::Not(testing::HasSubstr("network")));
    }
  }
}

TEST(FfmpegSource, ACutFileEndsLikeAWholeOne) {
  TemporaryFolder folder;
  for (const char* name : {"a.mkv", "a.ts", "a.flv"}) {
    makeClip(folder / name, {kH264});
    cutFile(folder / name, 0.6);
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    const auto packets = readAll(*source);
    EXPECT_GT(packets.size(), 10u) << name;
    EXPECT_LT(packets.size(), 48u) << name;
    EXPECT_EQ(source->state(), MediaSource::State::Ended) << name;
  }
}

// 48 pictures are 2 s.
TEST(FfmpegSource, TellsHowMuchOfACutFileIsMissing) {
  TemporaryFolder folder;
  for (const char* name : {"a.mkv", "a.flv", "a.avi"}) {
    makeClip(folder / name, {kH264});
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    readAll(*source);
    EXPECT_EQ(source->missing(), Duration(0)) << name << " is whole";
    ASSERT_TRUE(source->seek(mediaTime(60)).has_value()) << name;
    readAll(*source);
    EXPECT_EQ(source->missing(), Duration(0)) << name << " has nothing beyond its end";
    source->close();

    cutFile(folder / name, 0.6);
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    EXPECT_EQ(source->missing(), Duration(0)) << name << " is not known before its end";
    const auto packets = readAll(*source);
    // With reordering, a later picture's packet precedes those of earlier pictures.
    const double there = static_cast<double>(packets.size()) / 24;
    EXPECT_NEAR(toSeconds(source->missing()), 2 - there, 0.25) << name;
  }
}

// 48 pictures are 2 s. Where a seek skips the subtitle, nothing that was read lasts to the end that the container
// states.
TEST(FfmpegSource, SubtitlesThatOutlastThePictureAreNoMissingPart) {
  TemporaryFolder folder;
  ClipTrack track = kH264;
  track.gop = 12;
  makeClip(folder / "a.mkv", {track});
  std::ofstream(folder / "a.srt") << "1\n00:00:00,600 --> 00:00:09,000\nlong\n";
  const std::string mux = "cd '" + folder / "" + "' && ffmpeg -v error -i a.mkv -i a.srt -c copy b.mkv";
  if (std::system(mux.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "b.mkv").has_value());
  EXPECT_NEAR(toSeconds(source->duration()), 9, 0.01);
  for (const double place : {0.0, 1.6, 0.0}) {
    ASSERT_TRUE(source->seek(mediaTime(place)).has_value()) << place;
    EXPECT_GT(readAll(*source).size(), 0U) << place;
    EXPECT_EQ(source->missing(), Duration(0)) << place;
  }
}

// 90 pictures are 3 s. The containers state a length from time 0, or from the first picture.
TEST(FfmpegSource, AFilmThatBeginsLateIsWholeAndIsSoughtByItsOwnTime) {
  TemporaryFolder folder;
  for (const char* name : {"a.mkv", "a.mp4", "a.mov", "a.flv", "a.ts"}) {
    ClipTrack late = kH264;
    late.frames = 90;
    late.start = std::chrono::seconds(100);
    makeClip(folder / name, {late});
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    EXPECT_NEAR(toSeconds(source->duration()), 3, 0.05) << name;
    EXPECT_EQ(readAll(*source).size(), 90u) << name;
    EXPECT_EQ(source->missing(), Duration(0)) << name;
    ASSERT_TRUE(source->seek(mediaTime(2.5)).has_value()) << name;
    const auto packets = readAll(*source);
    ASSERT_FALSE(packets.empty()) << name;
    EXPECT_GT(packets[0].pts.value(), mediaTime(1)) << name;
    EXPECT_EQ(source->missing(), Duration(0)) << name;
  }
  cutFile(folder / "a.mkv", 0.6);
  const auto cut = makeFfmpegSource();
  ASSERT_TRUE(cut->open(folder / "a.mkv").has_value());
  const auto there = static_cast<double>(readAll(*cut).size()) / 30;
  EXPECT_NEAR(toSeconds(cut->missing()), 3 - there, 0.3);
}

TEST(FfmpegSource, TimesThatJumpBackGoOnWhereTheyWere) {
  TemporaryFolder folder;
  const std::string path = folder / "a.mkv";
  makeClip(path,
           {ClipTrack{.codec = "libx264", .pix_fmt = "yuv420p", .fps_num = 5, .frames = 75, .gop = 5, .b_frames = 2}},
           {}, {{.length = std::chrono::seconds(15)}});
  const auto times = [&] {
    const auto source = makeFfmpegSource();
    EXPECT_TRUE(source->open(path).has_value());
    std::vector<MediaTime> all;
    for (const Packet& packet : readAll(*source)) {
      if (packet.stream == 0) all.push_back(packet.pts.value());
    }
    EXPECT_EQ(source->missing(), Duration(0));
    std::sort(all.begin(), all.end());
    return all;
  };
  const auto before = times();
  ASSERT_GT(test::moveClustersBack(path, 6000, 4000), 0);
  testing::internal::CaptureStderr();
  const auto after = times();
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              testing::AllOf(HasSubstr("a.mkv: its times jump back by"), HasSubstr("made continuous")));
  ASSERT_EQ(after.size(), 75u);
  for (std::size_t k = 0; k < after.size(); ++k) {
    EXPECT_LE(std::chrono::abs(after[k] - before[k]), std::chrono::milliseconds(250)) << k;
    EXPECT_TRUE(k == 0 || after[k] > after[k - 1]) << k;
  }
}

// ISO/IEC 23002-3, signalled in the programme map, in any order of the streams.
TEST(FfmpegSource, TellsAuxiliaryVideoOfATransportStream) {
  TemporaryFolder folder;
  for (const int depth : {0, 1}) {
    makeClip(folder / "a.ts", {kH264, kH264});
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / "a.ts").has_value());
    for (const StreamInfo& stream : source->streams()) EXPECT_FALSE(stream.auxiliary);
    source->close();
    ASSERT_GT(test::signalAsDepth(folder / "a.ts", depth), 0);
    ASSERT_TRUE(source->open(folder / "a.ts").has_value());
    ASSERT_EQ(source->streams().size(), 2u);
    for (const StreamInfo& stream : source->streams()) {
      EXPECT_EQ(stream.auxiliary, stream.index == depth);
      EXPECT_EQ(stream.codec, "h264");
      EXPECT_EQ(stream.width, 64);
    }
  }
}

// ---- what each kind of source may open

TEST(FfmpegSource, OpensNoOtherKindOfAddress) {
  TemporaryFolder folder;
  makeClip(folder / "a.ts", {kH264});
  const std::string path = folder / "a.ts";
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open("file:" + path).has_value());
  source->close();
  for (const std::string& url : {"concat:" + path + "|" + path, "concatf:" + path, "subfile,,start,0,end,0,,:" + path,
                                 "crypto:" + path, "async:" + path, "cache:" + path, "file+crypto:" + path,
                                 std::string("pipe:0"), std::string("data:text/plain,x"),
                                 std::string("ftp://127.0.0.1/a.ts"), std::string("gopher://127.0.0.1/a.ts")}) {
    const Error error = openErrorOf(url);
    EXPECT_EQ(error.code, ErrorCode::Unsupported) << url;
    EXPECT_THAT(error.message, HasSubstr("not supported; use a file, http")) << url;
  }
}

class Playlists : public testing::Test {
 protected:
  Playlists() { makeClip(at("part.ts"), {kH264}); }
  [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }
  void write(const std::string& file, const std::string& part) const {
    writeFile(at(file),
              "#EXTM3U\n#EXT-X-VERSION:3\n#EXT-X-TARGETDURATION:2\n#EXTINF:1.6,\n" + part + "\n#EXT-X-ENDLIST\n");
  }
  // The number of packets; 0 if it cannot be opened.
  static std::size_t packetsOf(const std::string& url) {
    const auto source = makeFfmpegSource();
    if (!source->open(url)) return 0;
    return readAll(*source).size();
  }

  TemporaryFolder folder_;
};

TEST_F(Playlists, NameFilesBesideThemWhereTheyAreFiles) {
  write("film.m3u8", "part.ts");
  EXPECT_EQ(packetsOf(at("film.m3u8")), 48u);
  write("film.m3u8", "file://" + at("part.ts"));
  EXPECT_EQ(packetsOf(at("film.m3u8")), 48u);
}

TEST_F(Playlists, OfANetworkNameNothingOfThisMachine) {
  const test::HttpServer server(at(""));
  write("film.m3u8", "part.ts");
  ASSERT_EQ(packetsOf(server.url("film.m3u8")), 48u);
  for (const std::string& part :
       {"file://" + at("part.ts"), "file:" + at("part.ts"), "concat:" + at("part.ts") + "|" + at("part.ts"),
        "subfile,,start,0,end,0,,:" + at("part.ts"), "crypto:" + at("part.ts"), "crypto+file:" + at("part.ts"),
        "async:" + at("part.ts"), std::string("pipe:0"), std::string("udp://127.0.0.1:9"),
        std::string("concat:") + server.url("part.ts"), std::string("data:video/mp2t,x")}) {
    write("film.m3u8", part);
    EXPECT_EQ(packetsOf(server.url("film.m3u8")), 0u) << part;
  }
  // A list of lists is not opened either.
  write("inner.m3u8", "part.ts");
  const std::string variant = "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=100000\n";
  writeFile(at("outer.m3u8"), variant + "inner.m3u8\n");
  ASSERT_EQ(packetsOf(server.url("outer.m3u8")), 48u);
  writeFile(at("outer.m3u8"), variant + "file://" + at("inner.m3u8") + "\n");
  EXPECT_EQ(packetsOf(server.url("outer.m3u8")), 0u);
}

// Without a bound: 180,000 requests a minute and a gigabyte, until opening timed out.
TEST_F(Playlists, ThatNameThemselvesAreAskedForABoundedNumberOfTimes) {
  const test::HttpServer server(at(""));
  writeFile(at("self.m3u8"), "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=100000\nself.m3u8\n");
  EXPECT_EQ(packetsOf(server.url("self.m3u8")), 0u);
  EXPECT_LE(server.requests().size(), 1000u);
}

// Formats that are lists of addresses, or that open ports, are allowed only in files.
TEST_F(Playlists, OfOtherKindsAreForFilesAlone) {
  const test::HttpServer server(at(""));
  writeFile(at("film.ffconcat"), "ffconcat version 1.0\nfile part.ts\n");
  EXPECT_EQ(packetsOf(at("film.ffconcat")), 48u);
  EXPECT_EQ(packetsOf(server.url("film.ffconcat")), 0u);
  writeFile(at("film.sdp"),
            "v=0\r\no=- 0 0 IN IP4 127.0.0.1\r\ns=-\r\nc=IN IP4 127.0.0.1\r\nt=0 0\r\n"
            "m=video 9 RTP/AVP 33\r\n");
  const Error refused = openErrorOf(server.url("film.sdp"));
  EXPECT_EQ(refused.code, ErrorCode::Unsupported);
  EXPECT_THAT(refused.message, HasSubstr("forbidden to network sources"));
}

// A server on the loopback interface that sends the test's answers.
struct Server {
  UniqueFd listener{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  std::string url;

  Server() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof address;
    EXPECT_EQ(::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), length), 0);
    EXPECT_EQ(::listen(listener.get(), 4), 0);
    EXPECT_EQ(::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &length), 0);
    url = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/film.mkv";
  }
  [[nodiscard]] UniqueFd accept() const { return UniqueFd(::accept(listener.get(), nullptr, nullptr)); }
};

// What a server answers to everything, and the sentence for it.
TEST(FfmpegSource, EachKindOfNetworkErrorHasItsSentence) {
  const auto answered = [](const std::string& answer) {
    Server server;
    std::atomic<bool> ending{false};
    std::thread other([&] {
      while (!ending) {
        const UniqueFd to = server.accept();
        std::string request(4096, '\0');
        static_cast<void>(::recv(to.get(), request.data(), request.size(), 0));
        static_cast<void>(::send(to.get(), answer.data(), answer.size(), MSG_NOSIGNAL));
      }
    });
    const std::string message = openErrorOf(server.url).message;
    ending = true;
    ::shutdown(server.listener.get(), SHUT_RDWR);  // wakes accept()
    other.join();
    return message;
  };
  const auto status = [&](const std::string& line) {
    return answered("HTTP/1.1 " + line + "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
  };
  EXPECT_THAT(status("400 Bad Request"), HasSubstr("HTTP 4xx"));
  EXPECT_THAT(status("410 Gone"), HasSubstr("HTTP 4xx"));
  EXPECT_THAT(status("404 Not Found"), HasSubstr("the server does not have it"));
  EXPECT_THAT(status("403 Forbidden"), HasSubstr("refuses access"));
  EXPECT_THAT(status("503 Service Unavailable"), HasSubstr("HTTP 5xx"));
  EXPECT_THAT(status("302 Found\r\nLocation: /film.mkv"), HasSubstr("redirects without end"));
  EXPECT_THAT(answered("HTTP/1.1 200 OK\r\nContent-Length: 5\r\n\r\nhello"), HasSubstr("is no film"));

  const std::string no_name(70, 'a');  // longer than a name may be: it is not even asked for
  EXPECT_THAT(openErrorOf("http://" + no_name + "/film.mkv").message, HasSubstr("no host has this name"));
  EXPECT_THAT(openErrorOf("tcp://127.0.0.1").message, HasSubstr("not a whole address"));
  EXPECT_THAT(openErrorOf("http://127.0.0.1:1/film.mkv").message, HasSubstr("refuses the connection"));
}

TEST(FfmpegSource, ABrokenConnectionIsTakenUpWhereItBroke) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {kH264});
  std::ifstream file(folder / "a.mkv", std::ios::binary);
  const std::string film(std::istreambuf_iterator<char>(file), {});
  const std::size_t half = film.size() / 2;
  const auto source = makeFfmpegSource();
  Server server;
  std::string second_request(4096, '\0');
  std::thread other([&] {
    const auto answer = [](const UniqueFd& to, const std::string& text) {
      EXPECT_EQ(::send(to.get(), text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size()));
    };
    const std::string all = std::to_string(film.size());
    const std::string rest = std::to_string(film.size() - half);
    UniqueFd first = server.accept();
    EXPECT_GT(::recv(first.get(), second_request.data(), second_request.size(), 0), 0);
    answer(first,
           "HTTP/1.1 200 OK\r\nAccept-Ranges: bytes\r\nContent-Length: " + all + "\r\n\r\n" + film.substr(0, half));
    first.reset();
    const UniqueFd second = server.accept();
    const ssize_t length = ::recv(second.get(), second_request.data(), second_request.size(), 0);
    second_request.resize(static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
    answer(second, "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes " + std::to_string(half) + "-" +
                       std::to_string(film.size() - 1) + "/" + all + "\r\nContent-Length: " + rest + "\r\n\r\n" +
                       film.substr(half));
  });
  const bool opened = source->open(server.url).has_value();
  EXPECT_TRUE(opened);
  std::size_t packets = 0;
  while (opened) {
    const auto packet = source->read();
    if (!packet || !*packet) break;
    ++packets;
  }
  EXPECT_EQ(packets, 48u);
  ::shutdown(server.listener.get(), SHUT_RDWR);  // in case the second request never comes
  other.join();
  EXPECT_THAT(second_request, HasSubstr("bytes=" + std::to_string(half) + "-"));
}

// ---- interruption: the other thread acts once it has seen that `open` waits for it

TEST(FfmpegSource, InterruptEndsTheWaitForASilentServer) {
  const Server server;
  const auto source = makeFfmpegSource();
  UniqueFd connection;
  std::thread other([&] {
    connection = server.accept();  // and never answer
    source->interrupt();
  });
  const auto opened = source->open(server.url);
  other.join();
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::Cancelled);
}

// A connection without an answer, a port that receives nothing.
TEST(FfmpegSource, InterruptEndsEveryWaitSoon) {
  const Server silent;
  const std::string port = silent.url.substr(17, silent.url.rfind('/') - 17);
  for (const std::string& url :
       {"http://127.0.0.1:" + port + "/a.ts", "rtsp://127.0.0.1:" + port + "/a", "tcp://127.0.0.1:" + port,
        std::string("udp://127.0.0.1:0"), std::string("srt://127.0.0.1:9"), std::string("rtp://127.0.0.1:15004")}) {
    const auto source = makeFfmpegSource();
    MonotonicClock clock;
    MonotonicTime interrupted;
    std::thread other([&] {
      clock.sleepUntil(clock.now() + std::chrono::milliseconds(330));  // by then it waits, or will soon
      interrupted = clock.now();
      source->interrupt();
    });
    const auto opened = source->open(url);
    const MonotonicTime ended = clock.now();
    other.join();
    ASSERT_FALSE(opened.has_value()) << url;
    EXPECT_EQ(opened.error().code, ErrorCode::Cancelled) << url;
    EXPECT_LT(toSeconds(ended - interrupted), 2.0) << url;
    std::cout << url << ": interrupted in " << 1e3 * toSeconds(ended - interrupted) << " ms\n";
  }
}

TEST(FfmpegSource, InterruptEndsTheWaitForAPipesWriter) {
  TemporaryFolder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const auto source = makeFfmpegSource();
  UniqueFd writer;
  std::thread other([&] {
    while (!writer.valid())
      writer.reset(::open(path.c_str(), O_WRONLY | O_NONBLOCK));  // succeeds once a reader has opened it
    source->interrupt();
  });
  const auto opened = source->open(path);
  other.join();
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(opened.error().code, ErrorCode::Cancelled);
}

TEST(FfmpegSource, ReadsWhatComesThroughAPipeAndSaysThatItCannotSeek) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {kH264});
  const std::string path = folder / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::thread writer([&] {
    std::ifstream in(folder / "a.mkv", std::ios::binary);
    std::ofstream(path, std::ios::binary) << in.rdbuf();
  });
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(path).has_value());
  const auto sought = source->seek(MediaTime{});
  ASSERT_FALSE(sought.has_value());
  EXPECT_EQ(sought.error().code, ErrorCode::Unsupported);
  EXPECT_EQ(readAll(*source).size(), 48u);
  writer.join();
}

TEST(FfmpegSource, InterruptHoldsUntilTheNextOpen) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {kH264});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.mkv").has_value());
  ASSERT_TRUE(source->read().has_value());
  source->interrupt();
  for (int i = 0; i < 2; ++i) {
    const auto packet = source->read();
    ASSERT_FALSE(packet.has_value());
    EXPECT_EQ(packet.error().code, ErrorCode::Cancelled);
    EXPECT_EQ(source->seek(MediaTime{}).error().code, ErrorCode::Cancelled);
  }
  source->close();
  ASSERT_TRUE(source->open(folder / "a.mkv").has_value());
  EXPECT_EQ(readAll(*source).size(), 48u);
}

}  // namespace
}  // namespace relievo
