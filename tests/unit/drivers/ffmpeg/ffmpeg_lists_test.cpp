// SPDX-License-Identifier: Apache-2.0
// Seeks in HLS films that the ffmpeg program has made, local ones and from a server.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "drivers/ffmpeg/opening/later_parts.h"
#include "drivers/ffmpeg/opening/lists.h"
#include "tests/support/files.h"
#include "tests/support/network/http_server.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using ffmpeg::laterParts;
using test::TemporaryFolder;

constexpr const char* kWhole =
    "#EXTM3U\n#EXT-X-TARGETDURATION:4\n#EXT-X-MEDIA-SEQUENCE:7\n#EXT-X-MAP:URI=\"init.mp4\"\n"
    "#EXTINF:4.0,\na.m4s\n#EXTINF:2.5,\n#EXT-X-BYTERANGE:10@0\nb.m4s\n#EXTINF:3,\r\nc.m4s\r\n#EXT-X-ENDLIST\n";

TEST(LaterParts, AreThoseThatEndLater) {
  const std::string head = "#EXTM3U\n#EXT-X-MEDIA-SEQUENCE:";
  const std::string map = "\n#EXT-X-TARGETDURATION:4\n#EXT-X-MAP:URI=\"init.mp4\"\n";
  const std::string last = "#EXTINF:3,\r\nc.m4s\r\n#EXT-X-ENDLIST\n";
  const std::string second = "#EXTINF:2.5,\n#EXT-X-BYTERANGE:10@0\nb.m4s\n";
  EXPECT_EQ(laterParts(kWhole, fromSeconds(4.1)), head + "8" + map + second + last);
  EXPECT_EQ(laterParts(kWhole, fromSeconds(6.4)), head + "8" + map + second + last);
  EXPECT_EQ(laterParts(kWhole, fromSeconds(6.5)), head + "9" + map + last);
  const std::string last_alone = head + "9" + map + last;
  for (const double after_s : {9.4, 9.5, 60.0}) {
    EXPECT_EQ(laterParts(kWhole, fromSeconds(after_s)), last_alone) << "no list is without a part";
  }
  EXPECT_EQ(laterParts(kWhole, fromSeconds(1)), head + "7" + map + "#EXTINF:4.0,\na.m4s\n" + second + last);
}

// Their times may begin again.
TEST(LaterParts, BehindADiscontinuityStayWithThePartBeforeIt) {
  std::string list = kWhole;
  list.insert(list.find("#EXTINF:3"), "#EXT-X-DISCONTINUITY\n");
  const std::string head = "#EXTM3U\n#EXT-X-MEDIA-SEQUENCE:8\n";
  EXPECT_EQ(laterParts(list, fromSeconds(9)), head + list.substr(8, list.find("#EXT-X-MEDIA-SEQ") - 8) +
                                                  "#EXT-X-MAP:URI=\"init.mp4\"\n" +
                                                  list.substr(list.find("#EXTINF:2.5")));
}

TEST(LaterParts, OfOneFileKeepTheirPlaces) {
  const std::string ranges =
      "#EXTM3U\n#EXT-X-MEDIA-SEQUENCE:0\n#EXTINF:1,\n#EXT-X-BYTERANGE:10@5\na\n#EXTINF:1,\n#EXT-X-BYTERANGE:20\na\n"
      "#EXTINF:1,\n#EXT-X-BYTERANGE:30\r\na\n#EXT-X-ENDLIST\n";
  EXPECT_EQ(laterParts(ranges, fromSeconds(2)),
            "#EXTM3U\n#EXT-X-MEDIA-SEQUENCE:2\n#EXTINF:1,\n#EXT-X-BYTERANGE:30@35\r\na\n#EXT-X-ENDLIST\n");
}

TEST(LaterParts, OtherListsStayAsTheyAre) {
  const std::string whole = kWhole;
  const std::string live = whole.substr(0, whole.find("#EXT-X-ENDLIST"));
  for (const std::string& list : {live, std::string("#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=1\na.m3u8\n"),
                                  std::string("#EXTM3U\na.mkv\nb.mkv\n"), std::string()}) {
    EXPECT_EQ(laterParts(list, fromSeconds(5)), list);
  }
}

TEST(LaterParts, OfAListThatWasMovedHaveWholeAddresses) {
  using ffmpeg::withWholeAddresses;
  const std::string own = "http://host:80/a/b/list?x=/y";
  EXPECT_EQ(
      withWholeAddresses("#EXTM3U\n#EXT-X-MAP:URI=\"i.mp4\",BYTERANGE=\"1@0\"\nc.m4s\r\n\n/d\n//e/f\n?g\n../h", own),
      "#EXTM3U\n#EXT-X-MAP:URI=\"http://host:80/a/b/i.mp4\",BYTERANGE=\"1@0\"\nhttp://host:80/a/b/c.m4s\r\n\n"
      "http://host:80/d\nhttp://e/f\nhttp://host:80/a/b/list?g\nhttp://host:80/a/b/../h");
  for (const std::string list : {"https://k/l\n#EXT-X-KEY:URI=\"data:abc\"\n", "#EXT-X-KEY:METHOD=NONE\n", ""}) {
    EXPECT_EQ(withWholeAddresses(list, own), list);
  }
  EXPECT_EQ(withWholeAddresses("a\n", "http://host"), "http://host/a\n");
}

class ListSeek : public testing::Test {
 protected:
  // 8 s in parts of 1 s, each of which begins with a key frame. The sound begins 20 ms earlier, as AAC does in
  // Matroska.
  void SetUp() override {
    if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg program here";  // NOLINT
    const std::string command =
        "cd " + folder_ / "" +
        " && ffmpeg -v error -f lavfi -i testsrc2=s=64x48:r=25:d=8 -f lavfi -i sine=d=8 -c:v libx264 -g 25 -bf 0 -c:a "
        "aac "
        "film.mkv && ffmpeg -v error -i film.mkv -c copy -hls_time 1 -hls_playlist_type vod -hls_segment_type fmp4 "
        "mp4.m3u8 && ffmpeg -v error -i film.mkv -c copy -hls_time 1 -hls_playlist_type vod ts.m3u8";
    ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT
    writeFile(folder_ / "all.m3u8",
              "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=300000\nmp4.m3u8\n#EXT-X-STREAM-INF:BANDWIDTH=200000\nmp4.m3u8\n");
  }
  // The film with another list for its sound.
  [[nodiscard]] std::string withSound(const std::string& list) const {
    writeFile(folder_ / "sound.m3u8", list);
    writeFile(folder_ / "master.m3u8",
              "#EXTM3U\n#EXT-X-MEDIA:TYPE=AUDIO,GROUP-ID=\"a\",NAME=\"E\",DEFAULT=YES,URI=\"sound.m3u8\"\n"
              "#EXT-X-STREAM-INF:BANDWIDTH=300000,AUDIO=\"a\"\nmp4.m3u8\n");
    return folder_ / "master.m3u8";
  }
  // After a seek the pictures begin with a key frame at most a part's length before the target, and go on to the end.
  static void expectSeeks(const std::string& url) {
    SCOPED_TRACE(url);
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(url));
    for (const double target_s : {5.5, 0.0, 7.9, 2.5}) {
      for (int i = 0; i < 40; ++i) ASSERT_TRUE(source->read());  // as while it plays
      ASSERT_TRUE(source->seek(mediaTime(target_s))) << target_s;
      std::optional<double> first_s;
      double last_s = 0;
      for (const Packet& packet : readAll(*source)) {
        if (packet.stream != 0 || !packet.pts) continue;
        EXPECT_TRUE(first_s || packet.keyframe);
        first_s = first_s.value_or(toSeconds(packet.pts->time_since_epoch()));
        last_s = std::max(last_s, toSeconds(packet.pts->time_since_epoch()));
      }
      ASSERT_TRUE(first_s) << target_s;
      EXPECT_LE(*first_s, target_s + 0.03);
      EXPECT_GE(*first_s, target_s - 1.15);
      EXPECT_NEAR(last_s, 7.96, 0.1) << target_s;
      ASSERT_TRUE(source->seek(mediaTime(0)));
    }
  }

  static double lastOf(MediaSource& source) {
    double last_s = 0;
    for (const Packet& packet : readAll(source)) {
      if (packet.pts) last_s = std::max(last_s, toSeconds(packet.pts->time_since_epoch()));
    }
    return last_s;
  }

  TemporaryFolder folder_;
};

TEST_F(ListSeek, FindsItsPictures) {
  for (const char* list : {"mp4.m3u8", "ts.m3u8", "all.m3u8"}) expectSeeks(folder_ / list);
}

TEST_F(ListSeek, FindsItsPicturesOnAServer) {
  const test::HttpServer server(folder_ / "");
  for (const char* list : {"mp4.m3u8", "ts.m3u8", "all.m3u8"}) expectSeeks(server.url(list));
}

TEST_F(ListSeek, FindsThePartsOfAListThatIsElsewhereAndNeedsACookie) {
  test::HttpServer server(folder_ / "");
  server.moved = {{"r/film.m3u8", "mp4.m3u8"}, {"r/all.m3u8", "all.m3u8"}, {"r/watch", "mp4.m3u8"}};
  server.cookie = "a=b";
  for (const char* list : {"r/film.m3u8", "r/all.m3u8", "r/watch"}) expectSeeks(server.url(list));
}

TEST_F(ListSeek, TakesListsByWhatTheyAre) {
  std::filesystem::rename(folder_ / "mp4.m3u8", folder_ / "variant");
  writeFile(folder_ / "names.m3u8", "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=300000\nvariant\n");
  const test::HttpServer server(folder_ / "");
  expectSeeks(server.url("names.m3u8"));
}

TEST_F(ListSeek, BehindADiscontinuityReadsFromThePartBeforeIt) {
  std::string list = test::contentOf(folder_ / "mp4.m3u8");
  list.insert(list.rfind("#EXTINF", list.find("mp44.m4s")), "#EXT-X-DISCONTINUITY\n");
  writeFile(folder_ / "jumps.m3u8", list);
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder_ / "jumps.m3u8"));
  ASSERT_TRUE(source->seek(mediaTime(6)));
  const auto packets = readAll(*source);
  ASSERT_FALSE(packets.empty());
  ASSERT_TRUE(packets.front().pts);
  EXPECT_NEAR(toSeconds(packets.front().pts->time_since_epoch()), 3, 0.15);
  EXPECT_NEAR(toSeconds(packets.back().pts->time_since_epoch()), 7.96, 0.1);
}

// Of a film in one file the head lies before all parts. They were walked through at each opening and seek.
TEST_F(ListSeek, AsksForTheLanguagesOnce) {
  const std::string command =
      "cd " + folder_ / "" +
      " && ffmpeg -v error -f lavfi -i testsrc2=s=320x240:r=25:d=16,noise=alls=60:allf=t -f lavfi -i sine=d=16 -c:v "
      "libx264 -preset ultrafast -crf 12 -g 25 -c:a aac -hls_time 1 -hls_playlist_type vod -hls_segment_type fmp4 "
      "-hls_flags single_file one.m3u8";
  ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT
  const test::HttpServer server(folder_ / "");
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(server.url("one.m3u8")));
  const std::size_t opened = server.requests().size();
  EXPECT_LE(opened, 8u) << "the list, the head and some parts, and the head again";
  ASSERT_TRUE(source->seek(mediaTime(5)));
  EXPECT_LE(server.requests().size() - opened, opened);
}

// FFmpeg crashed on a list of the sound without a part behind the target.
TEST_F(ListSeek, BehindTheEndOfItsSoundFindsThePictures) {
  std::string sound = test::contentOf(folder_ / "mp4.m3u8");
  const std::size_t half = sound.find("mp44.m4s");
  ASSERT_NE(half, std::string::npos);
  sound = sound.substr(0, sound.rfind("#EXTINF", half)) + "#EXT-X-ENDLIST\n";
  const std::string url = withSound(sound);
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(url));
  ASSERT_TRUE(source->seek(mediaTime(6)));
  EXPECT_NEAR(lastOf(*source), 7.96, 0.1);
}

TEST_F(ListSeek, ThatFindsOtherTracksIsRefusedAndTheFilmGoesOn) {
  const std::string url = withSound(test::contentOf(folder_ / "mp4.m3u8"));
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(url));
  const std::size_t streams = source->streams().size();
  writeFile(url, "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=300000\nmp4.m3u8\n");
  const auto sought = source->seek(mediaTime(6));
  ASSERT_FALSE(sought);
  EXPECT_EQ(sought.error().code, ErrorCode::Unsupported);
  std::set<int> read;
  for (const Packet& packet : readAll(*source)) read.insert(packet.stream);
  EXPECT_EQ(read.size(), streams);
}

// FFmpeg crashed as soon as it read such a film.
TEST_F(ListSeek, OfAFilmWhoseSoundHasNoPartFindsThePictures) {
  for (const char* const end : {"#EXT-X-ENDLIST\n", ""}) {
    const std::string url = withSound(std::string("#EXTM3U\n#EXT-X-TARGETDURATION:1\n") + end);
    const auto source = makeFfmpegSource();
    ASSERT_TRUE(source->open(url));
    ASSERT_TRUE(source->seek(mediaTime(6)));
    EXPECT_GT(readAll(*source).size(), 40u);
  }
}

}  // namespace
}  // namespace relievo
