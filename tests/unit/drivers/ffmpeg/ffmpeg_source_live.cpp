// SPDX-License-Identifier: Apache-2.0
// Sources that cannot go back: a stream in real time that is joined in its middle, pipes, servers of whole files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/files.h"
#include "tests/support/network/http_server.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_server.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using test::makeClip;
using test::TemporaryFolder;

// Two tracks of 60 pictures a second and sound: between two key frames, which alone carry the tags, are 160 packets.
TEST(FfmpegSource, AStreamThatIsJoinedBehindAKeyFrameHasItsTags) {
  TemporaryFolder folder;
  const std::string picture = "-f lavfi -i testsrc=s=64x48:r=60 ";
  const std::string command =
      "cd " + std::string(folder / "") + " && ffmpeg -v error " + picture + picture +
      "-f lavfi -i sine -map 0 -map 1 -map 2 -t 4 -c:v libx264 -preset ultrafast -pix_fmt yuv420p -g 60 "
      "-x264-params nal-hrd=vbr -maxrate 1M -bufsize 1M "  // else FFmpeg puts the tags behind the picture
      "-bsf:v h264_metadata=sei_user_data=6e1f43b7-0d52-4c9e-a735-72656c696576+DEPTH_LAW=inverse -c:a mp2 a.ts";
  // NOLINTNEXTLINE(bugprone-command-processor)
  if (std::system(command.c_str()) != 0) GTEST_SKIP() << "no ffmpeg program here";
  std::ifstream file(folder / "a.ts", std::ios::binary);
  const std::string film(std::istreambuf_iterator<char>(file), {});
  const Server server;
  std::thread sender([&] {
    const UniqueFd to = server.accept();
    const std::size_t joined = film.size() / 188 / 32 * 188;  // an eighth of a second after the first key frames
    static_cast<void>(::send(to.get(), film.data() + joined, film.size() - joined, MSG_NOSIGNAL));
  });
  const auto source = makeFfmpegSource();
  EXPECT_TRUE(source->open("tcp://127.0.0.1:" + server.port).has_value());
  int tagged = 0;
  for (const StreamInfo& stream : source->streams()) {
    const auto law = stream.tags.find("DEPTH_LAW");
    tagged += law != stream.tags.end() && law->second == "inverse" ? 1 : 0;
  }
  EXPECT_EQ(tagged, 2);
  source->close();
  sender.join();
}

std::size_t packetsOf(const std::string& url) {
  const auto source = makeFfmpegSource();
  const auto opened = source->open(url);
  EXPECT_TRUE(opened) << url;
  return opened ? readAll(*source).size() : 0;
}

// FFmpeg has read past the pictures when it comes to the index, and the source seemed to have gone away.
TEST(FfmpegSource, AnIndexBehindThePicturesIsToldWhereNothingCanGoBack) {
  TemporaryFolder folder;
  const ClipTrack large{.codec = "mjpeg", .pix_fmt = "yuvj420p", .width = 320, .height = 240, .frames = 30};
  makeClip(folder / "large.mp4", {large});
  makeClip(folder / "large.mkv", {large});
  makeClip(folder / "small.mp4", {ClipTrack{.codec = "mjpeg", .pix_fmt = "yuvj420p", .frames = 2}});
  ASSERT_GT(std::filesystem::file_size(folder / "large.mp4"), 60000u);
  test::HttpServer server(folder / "");
  EXPECT_EQ(packetsOf(server.url("large.mp4")), 30u);
  server.ranges = false;
  const Error refused = openErrorOf(server.url("large.mp4"));
  EXPECT_EQ(refused.code, ErrorCode::Unsupported);
  EXPECT_THAT(refused.message, testing::HasSubstr("its index is at its end"));
  EXPECT_EQ(packetsOf(server.url("large.mkv")), 30u);
  EXPECT_EQ(packetsOf(server.url("small.mp4")), 2u) << "all of it is still held";

  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << test::contentOf(folder / "large.mp4"); });
  EXPECT_THAT(openErrorOf(pipe).message, testing::HasSubstr("its index is at its end"));
  writer.join();
}

TEST(FfmpegSource, AMultiplexFromAServerOfWholeFilesCannotSeekAndGoesOn) {
  TemporaryFolder folder;
  makeClip(folder / "a.ts", {kH264});
  test::HttpServer server(folder / "");
  server.ranges = false;
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(server.url("a.ts")));
  EXPECT_TRUE(source->seek(mediaTime(1))) << "all of it is still to be read";
  ASSERT_TRUE(source->read());
  for (const double at_s : {1.0, 0.0}) {
    const auto sought = source->seek(mediaTime(at_s));
    ASSERT_FALSE(sought) << at_s;
    EXPECT_EQ(sought.error().code, ErrorCode::Unsupported);
  }
  EXPECT_EQ(readAll(*source).size(), 47U);
  server.ranges = true;
  const auto other = makeFfmpegSource();
  ASSERT_TRUE(other->open(server.url("a.ts")));
  EXPECT_TRUE(other->seek(mediaTime(1)));
}

}  // namespace
}  // namespace relievo
