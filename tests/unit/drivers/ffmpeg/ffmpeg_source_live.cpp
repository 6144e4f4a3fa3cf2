// SPDX-License-Identifier: Apache-2.0
// A stream in real time that is joined in its middle.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/unit/drivers/ffmpeg/ffmpeg_server.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

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

}  // namespace
}  // namespace relievo
