// SPDX-License-Identifier: Apache-2.0
// Files that are cut, or that begin late: what is missing, and their times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/mkv_patch.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::TemporaryFolder;
using testing::HasSubstr;

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

// 50 pictures are 2 s. Of a cut file with sound FFmpeg shortens the stated length.
TEST(FfmpegSource, TellsHowMuchIsMissingOfACutAviWithSound) {
  TemporaryFolder folder;
  const ClipTrack track{.codec = "mjpeg", .pix_fmt = "yuvj420p", .fps_num = 25, .frames = 50};
  makeClip(folder / "a.avi", {track}, {}, {{.codec = "pcm_s16le", .length = std::chrono::seconds(2)}});
  for (const double part : {1.0, 0.6}) {
    cutFile(folder / "a.avi", part);
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / "a.avi").has_value()) << part;
    const auto packets = readAll(*source);
    const auto pictures = std::ranges::count(packets, 0, &Packet::stream);
    const double missing = 2 - static_cast<double>(pictures) / 25;
    EXPECT_EQ(missing > 0.5, part < 1) << pictures;
    EXPECT_NEAR(toSeconds(source->missing()), missing, part < 1 ? 0.1 : 0) << part;
  }
}

// Pictures of 100 ms each. Whether whole pictures after the last one are missing cannot be known.
TEST(FfmpegSource, TellsThatAY4mFileEndsWithinAPicture) {
  TemporaryFolder folder;
  std::string film = "YUV4MPEG2 W16 H8 F10:1 Cmono\n";
  for (int i = 0; i < 3; ++i) film += "FRAME\n" + std::string(128, static_cast<char>('a' + i));
  const auto missing = [&](const std::string& content) {
    writeFile(folder / "a.y4m", content);
    const auto source = makeFfmpegSource();
    if (!source->open(folder / "a.y4m").has_value()) return Duration(-1);
    readAll(*source);
    return source->missing();
  };
  for (const std::size_t less : {1U, 70U, 128U, 131U, 133U}) {
    EXPECT_EQ(missing(film.substr(0, film.size() - less)), std::chrono::milliseconds(100)) << less;
  }
  EXPECT_EQ(missing(film), Duration(0));
  EXPECT_EQ(missing(film.substr(0, film.size() - 134)), Duration(0)) << "two whole pictures";
  EXPECT_EQ(missing(film + "\n"), Duration(0)) << "no picture begins there";
}

// 48 pictures are 2 s. A multiplex states no length: its last time was read when it was opened.
TEST(FfmpegSource, TellsHowMuchIsMissingOfAMultiplexThatIsCutWhileItIsRead) {
  TemporaryFolder folder;
  for (const char* name : {"a.ts", "a.mpg"}) {
    const ClipTrack large{.codec = "mpeg2video", .pix_fmt = "yuv420p", .width = 320, .height = 240, .frames = 48};
    makeClip(folder / name, {large});
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    readAll(*source);
    EXPECT_EQ(source->missing(), Duration(0)) << name << " is whole";
    ASSERT_TRUE(source->seek(MediaTime{}).has_value()) << name;
    cutFile(folder / name, 0.5);
    const auto packets = readAll(*source);
    const double there = static_cast<double>(packets.size()) / 24;
    EXPECT_LT(there, 1.7) << name;
    EXPECT_NEAR(toSeconds(source->missing()), 2 - there, 0.3) << name;
  }
}

// The file of a copy that was broken off, on a file system that had reserved the whole size for it. 48 pictures are 2
// s.
TEST(FfmpegSource, TellsThatATransportStreamEndsInWhatIsNone) {
  TemporaryFolder folder;
  const ClipTrack large{.codec = "mpeg2video", .pix_fmt = "yuv420p", .width = 320, .height = 240, .frames = 48};
  makeClip(folder / "a.ts", {large});
  const auto whole = std::filesystem::file_size(folder / "a.ts");
  cutFile(folder / "a.ts", 0.3);
  std::filesystem::resize_file(folder / "a.ts", whole);
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.ts").has_value());
  const double there = static_cast<double>(readAll(*source).size()) / 24;
  EXPECT_LT(there, 1);
  EXPECT_GT(source->missing(), std::chrono::milliseconds(400)) << "by bytes, of which the first picture has the most";
  EXPECT_LT(toSeconds(source->missing()), 2 - there);
}

// 48 pictures are 2 s. What a sender, a recorder or another program adds after a film does not count as part of it.
TEST(FfmpegSource, AMultiplexWithATailThatIsNoPictureIsWhole) {
  std::string nulls, padding, noise;  // of 180 KB: ISO/IEC 13818-1, 2.4.3.3 and 2.4.3.7
  for (int i = 0; i < 1000; ++i) nulls += std::string("\x47\x1f\xff\x10", 4) + std::string(184, '\xff');
  for (int i = 0; i < 90; ++i) padding += std::string("\0\0\1\xbe\x07\xfa", 6) + std::string(2042, '\xff');
  for (unsigned i = 0, x = 1; i < 180'000; ++i, x = x * 1664525U + 1013904223U) noise += static_cast<char>(x >> 24U);
  const std::vector<std::pair<const char*, const std::string*>> films{
      {"nulls.ts", &nulls}, {"noise.ts", &noise}, {"padding.mpg", &padding}, {"noise.mpg", &noise}};
  TemporaryFolder folder;
  for (const auto& [name, tail] : films) {
    const ClipTrack large{.codec = "mpeg2video", .pix_fmt = "yuv420p", .width = 320, .height = 240, .frames = 48};
    makeClip(folder / name, {large});
    std::ofstream(folder / name, std::ios::binary | std::ios::app) << *tail;
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    EXPECT_EQ(readAll(*source).size(), 48U) << name;
    EXPECT_EQ(source->missing(), Duration(0)) << name;
    ASSERT_TRUE(source->seek(MediaTime{}).has_value()) << name;
    EXPECT_EQ(readAll(*source).size(), 48U) << name << ", once more";
  }
}

// How much of the film is missing behind it cannot be known.
TEST(FfmpegSource, TellsThatAFileEndsWithinItsLastPacket) {
  TemporaryFolder folder;
  const std::string make = "cd '" + folder / "" +
                           "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=64x48:r=10:d=3 -c:v libx264 -g 10 "
                           "a.ts -c:v libx264 -mpegts_m2ts_mode 1 a.m2ts -c:v libx264 -g 10 -movflags "
                           "frag_keyframe+empty_moov a.mp4 -c:v libtheora a.ogv a.gif -c:v wmv2 a.wmv";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  std::ofstream(folder / "a.gif", std::ios::binary | std::ios::app) << '\n';     // some programs end files so
  for (const char* name : {"a.ts", "a.m2ts", "a.mp4", "a.ogv", "a.gif", "a.wmv"}) {
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    EXPECT_GE(readAll(*source).size(), 29U) << name;  // FFmpeg 7.1 writes one packet of Theora less
    EXPECT_EQ(source->missing(), Duration(0)) << name << " is whole";
    source->close();
    const auto packets = std::filesystem::file_size(folder / name) * 3 / 5 / 192;
    std::filesystem::resize_file(folder / name, packets * (name == std::string("a.ts") ? 188 : 192) + 60);
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    EXPECT_LT(readAll(*source).size(), 30U) << name;
    EXPECT_GT(source->missing(), Duration(0)) << name;
  }
}

TEST(FfmpegSource, TellsHowMuchIsMissingBehindAHoleInAGif) {
  TemporaryFolder folder;
  const std::string make = "cd '" + folder / "" + "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=d=3:r=10 a.gif";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  const auto bytes = static_cast<std::streamoff>(std::filesystem::file_size(folder / "a.gif"));
  std::fstream file(folder / "a.gif", std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(bytes / 2);
  file << std::string(static_cast<std::size_t>(bytes / 10), '\0') << std::flush;
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.gif").has_value());
  const std::size_t pictures = readAll(*source).size();
  EXPECT_LT(pictures, 30U);
  EXPECT_NEAR(toSeconds(source->missing()), 3 - 0.1 * static_cast<double>(pictures), 0.5);
}

// Each block was read with a buffer of its own: 1,000,000 took minutes.
TEST(FfmpegSource, CommentsAtTheEndOfAGifAreReadOnce) {
  TemporaryFolder folder;
  const std::string make = "cd '" + folder / "" + "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=d=1:r=10 a.gif";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  constexpr int kComments = 5000;
  std::string comments;
  for (int comment = 0; comment < kComments; ++comment) comments += std::string("\x21\xfe\5hello\0", 9);
  std::fstream file(folder / "a.gif", std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(-1, std::ios::end);
  file << comments << ';' << std::flush;
  const auto bytesRead = [] {
    std::ifstream counts("/proc/self/io");
    std::string word;
    std::uint64_t bytes = 0;
    counts >> word >> bytes;  // rchar
    return bytes;
  };
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "a.gif").has_value());
  const std::uint64_t before = bytesRead();
  if (before == 0) GTEST_SKIP() << "the system does not tell how much a process reads";
  const std::size_t pictures = readAll(*source).size();
  EXPECT_GE(pictures, 10U);
  EXPECT_LE(pictures, 11U) << "FFmpeg 7.1 hands over the comments behind the last picture, too";
  EXPECT_EQ(source->missing(), Duration(0));
  EXPECT_LT(bytesRead() - before, 5 * std::filesystem::file_size(folder / "a.gif"));
}

// A picture lasts 1 s. FLV counts its length from the first decoding time, WMV says no picture's length.
TEST(FfmpegSource, AWholeFilmOfOnePictureASecondLacksNothing) {
  TemporaryFolder folder;
  const std::string make = "cd '" + folder / "" +
                           "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=64x48:r=1:d=8 -c:v libx264 a.flv "
                           "-c:v libx264 a.mkv -c:v libx264 a.mp4 -c:v libx264 a.ts -c:v wmv2 a.wmv -c:v mjpeg "
                           "-pix_fmt yuvj420p a.avi";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  for (const char* name : {"a.flv", "a.mkv", "a.mp4", "a.ts", "a.wmv", "a.avi"}) {
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    EXPECT_EQ(readAll(*source).size(), 8U) << name;
    EXPECT_EQ(source->missing(), Duration(0)) << name;
    EXPECT_NEAR(toSeconds(source->duration()), name == std::string("a.ts") ? 7 : 8, 1.01) << name;
  }
}

TEST(FfmpegSource, SoundThatBeginsLateIsNoMissingPart) {
  TemporaryFolder folder;
  const std::string make = "cd '" + folder / "" +
                           "' && ffmpeg -nostdin -v error -f lavfi -i testsrc2=s=64x48:r=25:d=4 -itsoffset 2 -f lavfi "
                           "-i sine=d=4 -c:v wmv2 -c:a wmav2 a.wmv -c:v libx264 -c:a aac a.mkv";
  if (std::system(make.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  for (const char* name : {"a.wmv", "a.mkv"}) {
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(folder / name).has_value()) << name;
    EXPECT_NEAR(toSeconds(source->duration()), 6, 0.1) << name;
    readAll(*source);
    EXPECT_EQ(source->missing(), Duration(0)) << name;
  }
}

// 48 pictures are 2 s. The container's end is that of a subtitle. If a seek skips it, no packet that was read reaches
// that end, but nothing is missing.
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

}  // namespace
}  // namespace relievo
