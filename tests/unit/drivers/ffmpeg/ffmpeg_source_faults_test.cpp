// SPDX-License-Identifier: Apache-2.0
// Files that the FFmpeg source cannot open, each with its message, and depth in transport streams.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <climits>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/refusal.h"
#include "drivers/ffmpeg/watch.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ts_patch.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

extern "C" {
#include <libavutil/mem.h>
}

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;
using testing::HasSubstr;

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

// The largest picture has 268 MB. A text in a PNG of 300 KB unpacked to 300 MB, in blocks of up to 512 MB.
TEST(FfmpegSource, FFmpegAllocatesNoBlockThatNoPictureNeeds) {
  boundFfmpegBlocks();
  const std::unique_ptr<void, decltype(&av_free)> picture(av_malloc(268'435'456), av_free);
  const std::unique_ptr<void, decltype(&av_free)> more(av_malloc(301'000'000), av_free);
  av_max_alloc(INT_MAX);  // FFmpeg's own bound
  EXPECT_NE(picture, nullptr);
  EXPECT_EQ(more, nullptr);
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
  writeFile(folder / "umlauts.mp4", "Gr\xc3\xbc\xc3\x9f");
  writeFile(folder / "empty.mkv", "");
  writeFile(folder / "noise.mkv", std::string(300, '\xff'));
  makeClip(folder / "no-index.mov", {kH264});
  cutFile(folder / "no-index.mov", 0.5);  // the index is at the end
  for (const char* name : {"text.mkv", "text.txt", "umlauts.mp4"}) {
    EXPECT_EQ(openErrorOf(folder / name).code, ErrorCode::Corrupt) << name;
    EXPECT_THAT(openErrorOf(folder / name).message, HasSubstr("it is text, not a film")) << name;
  }
  for (const char* name : {"empty.mkv", "noise.mkv", "no-index.mov"}) {
    EXPECT_EQ(openErrorOf(folder / name).code, ErrorCode::Corrupt) << name;
    EXPECT_THAT(openErrorOf(folder / name).message, HasSubstr("not a media file")) << name;
  }
}

// FFmpeg opens patterns and addresses with a protocol by itself; its error code must lead to the same message.
TEST(FfmpegSource, WithoutADescriptorItNamesTheLimit) {
  TemporaryFolder folder;
  makeClip(folder / "a.mkv", {ClipTrack{.frames = 2}});
  ASSERT_TRUE(makeFfmpegSource()->open(folder / "a.mkv").has_value());
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  const Error error = openErrorOf(folder / "a.mkv");
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_EQ(error.code, ErrorCode::Exhausted);
  EXPECT_EQ(error.os_error, EMFILE);
  EXPECT_THAT(error.message, HasSubstr("ulimit -n"));
  EXPECT_THAT(ffmpeg::openError(-EMFILE).message, HasSubstr("ulimit -n"));
}

TEST(FfmpegSource, AY4mHeaderOfTooLargePicturesNamesTheLargest) {
  TemporaryFolder folder;
  for (const char* size : {"W20000 H20000", "H20000 W20000"}) {
    writeFile(folder / "a.y4m", std::string("YUV4MPEG2 ") + size + " F25:1 C420\nFRAME\n" + std::string(5000, '\0'));
    const Error error = openErrorOf(folder / "a.y4m");
    EXPECT_EQ(error.code, ErrorCode::Unsupported) << size;
    EXPECT_THAT(error.message, HasSubstr("4096 x 4096")) << size;
  }
  writeFile(folder / "b.y4m", "YUV4MPEG2 W0 H16 F25:1 C420\nFRAME\n");
  EXPECT_THAT(openErrorOf(folder / "b.y4m").message, testing::Not(HasSubstr("4096 x 4096")));
}

// They are recognised by their first bytes, even where FFmpeg would find something like sound in what follows.
TEST(FfmpegSource, RecordingsThatNothingReadsAreNamedWithTheCommandThatConvertsThem) {
  const TemporaryFolder folder;
  using namespace std::string_view_literals;
  const struct {
    const char* name;
    std::string_view begin;
    std::vector<const char*> words;
  } kFormats[] = {
      {"a.db3", "SQLite format 3\0"sv, {"ROS 2 bag", "RELIEVO_ROSBAG"}},
      {"a.mcap", "\x89MCAP0\r\n"sv, {"MCAP", "RELIEVO_ROSBAG"}},
      {"a.h5", "\x89HDF\r\n\x1a\n"sv, {"HDF5", ".npy", "h5py.File"}},
      {"frame.0000.depth_meters.hdf5", "\x89HDF\r\n\x1a\n"sv, {"Hypersim", "name its folder"}},
      {"a.bag", "#ROSBAG V2.0\n"sv, {"ROS bag", "RELIEVO_ROSBAG"}},
      {"a.oni", "NI10\1"sv, {"OpenNI", "RELIEVO_OPENNI"}},
      {"a.klg", "\6\0\0\0"sv, {"scan", "RELIEVO_SCAN"}},
      {"a.r3d", "PK\3\4"sv, {"Record3D", "EXR"}},
      {"a.npz", "PK\3\4"sv, {"unzip", ".npy"}},
      {"a.zip", "PK\3\4"sv, {"unpack", "folder"}},
      {"a.svo2", "\x89MCAP0\r\n"sv, {"ZED", "ZED_SVO_Export"}},
      {"a.ply", "ply\nformat"sv, {"point cloud", "recording"}},
      {"a.pcd", "# .PCD v0.7"sv, {"point cloud", "recording"}},
      {"N46E007.hgt", "\1\2"sv, {"SRTM", "gray16be", "--as heights"}},
      {"a.exr", "\x76\x2f\x31\1\2\x8\0\0"sv, {"deep EXR", "--flatten"}},
      {"a.mat", "MATLAB 5.0 MAT-file"sv, {"MATLAB", ".npy", "loadmat"}},
      {"nyu.mat", "MATLAB 7.3 MAT-file"sv, {"MATLAB 7.3", "h5py", "swapaxes(-1, -2)"}},
      {"a.raw", "\1\2"sv, {"without a picture size", "gray16le"}},
      {"a.bin", "\1\2"sv, {"without a picture size", "gray16le"}},
      {"a.yuv", "\1\2"sv, {"without a size", "its name", "of 8 bits FORMAT is yuv420p,", "of 16 yuv420p16le"}},
      {"a.csv", "1.2,1.3\n"sv, {"table", "numpy.loadtxt"}},
      {"a.pth", "PK\3\4"sv, {"PyTorch", "torch.load"}},
      {"a.yml", "%YAML:1.0"sv, {"OpenCV", "FileStorage"}},
      {"a.gz", "\x1f\x8b"sv, {"unpack"}},
      {"b.bin", "1280&720&1&"sv, {"COLMAP", "reshape(int(h), int(w))"}},
      {"depths.dmb", "\1\0\0\0\360\0\0\0"sv, {"Gipuma", "numpy.fromfile"}},
      {"a.flo", "PIEH"sv, {"optical flow", "no depth"}},
      {"a.dcm", "\0\0\0\0"sv, {"medical", "if its numbers are depth", ".npy"}},
      {"a.zdf", "\x89HDF\r\n\x1a\n"sv, {"Zivid"}},
      {"a.dpt", "\360\0\0\0\100\1\0\0"sv, {"LINEMOD", "numpy.fromfile"}},
      {"a.png", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR12345678123451234\0\0\0\10acTL"sv, {"animated", ".apng"}},
      {"a.webp", "RIFF\0\1\0\0WEBPVP8X\x0a\0\0\0\2\0\0\0"sv, {"animated WebP", "convert FILE %04d.png"}},
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
  makeClip(folder / "a.png", {{.codec = "png", .pix_fmt = "gray", .width = 8192, .height = 6208, .frames = 1}});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.png"));
  EXPECT_EQ(source->streams()[0].width, 0);
  makeClip(folder / "b.png", {{.codec = "png", .pix_fmt = "gray", .width = 4096, .height = 4096, .frames = 1}});
  const auto fits = makeFfmpegSource();
  ASSERT_TRUE(fits->open(folder / "b.png"));
  EXPECT_EQ(fits->streams()[0].width, 4096);
  EXPECT_TRUE(fits->notes().empty());
  makeClip(folder / "c.png", {{.codec = "png", .pix_fmt = "gray", .width = 8192, .height = 4096, .frames = 1}});
  const auto photo = makeFfmpegSource();
  ASSERT_TRUE(photo->open(folder / "c.png"));
  EXPECT_EQ(photo->streams()[0].width, 4096) << "its decoder halves it";
  EXPECT_EQ(photo->streams()[0].height, 2048);
  EXPECT_THAT(photo->notes(), testing::ElementsAre(testing::HasSubstr("8192 x 4096")));
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

}  // namespace
}  // namespace relievo
