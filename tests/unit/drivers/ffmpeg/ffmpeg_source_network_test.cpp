// SPDX-License-Identifier: Apache-2.0
// What the FFmpeg source may open, errors of a network, and interruption.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "drivers/ffmpeg/address.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/ffmpeg/refusal.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/mkv_patch.h"
#include "tests/support/network/http_server.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_server.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using test::makeClip;
using test::TemporaryFolder;
using testing::HasSubstr;

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

// Without a bound, there would be 180,000 requests a minute and a gigabyte of memory until opening timed out.
TEST_F(Playlists, ThatNameThemselvesAreAskedForABoundedNumberOfTimes) {
  const test::HttpServer server(at(""));
  writeFile(at("self.m3u8"), "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=100000\nself.m3u8\n");
  EXPECT_EQ(packetsOf(server.url("self.m3u8")), 0u);
  EXPECT_LE(server.requests().size(), 1000u);
}

TEST_F(Playlists, PartsThatABusyServerRefusesAreAskedForAgain) {
  test::HttpServer server(at(""));
  server.busy["part.ts"] = 1;
  write("film.m3u8", "part.ts");
  EXPECT_EQ(packetsOf(server.url("film.m3u8")), 48u);
  EXPECT_THAT(server.requests(), testing::IsSupersetOf({"GET /part.ts 503", "GET /part.ts 200"}));
}

// FFmpeg asks for the next part ahead, and for one that is refused again in time.
TEST_F(Playlists, APartThatComesLateIsNotCalledLost) {
  test::HttpServer server(at(""));
  std::filesystem::copy(at("part.ts"), at("next.ts"));
  write("film.m3u8", "part.ts\n#EXTINF:1.6,\nnext.ts");
  const auto told = [&](int refusals) {
    server.busy["next.ts"] = refusals;
    testing::internal::CaptureStderr();
    EXPECT_EQ(packetsOf(server.url("film.m3u8")), refusals < 9 ? 96u : 48u);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(told(3), testing::Not(HasSubstr("left out")));
  EXPECT_THAT(told(9), HasSubstr("next.ts cannot be opened and is left out\n"));
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

// What a server answers to everything, and the error message for it.
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

TEST(FfmpegSource, ARefusedSeekForgetsNothing) {
  TemporaryFolder folder;
  const auto noise = [](int, int c, int r, int k) { return (c + 160U * r + 19200U * k) * 2654435761U >> 24; };
  makeClip(folder / "a.flv", {{.codec = "flv", .pix_fmt = "yuv420p", .width = 160, .height = 120, .sample = noise}});
  cutFile(folder / "a.flv", 0.6);
  std::ifstream file(folder / "a.flv", std::ios::binary);
  std::string film(std::istreambuf_iterator<char>(file), {});
  film.insert(0, "HTTP/1.1 200 OK\r\nContent-Length: " + std::to_string(film.size()) + "\r\n\r\n");
  const auto source = makeFfmpegSource();
  Server server;  // sends no parts of a file
  std::thread other([&] {
    const UniqueFd to = server.accept();
    std::string request(4096, '\0');
    EXPECT_GT(::recv(to.get(), request.data(), request.size(), 0), 0);
    EXPECT_EQ(::send(to.get(), film.data(), film.size(), MSG_NOSIGNAL), static_cast<ssize_t>(film.size()));
  });
  const std::size_t pictures = source->open(server.url) ? readAll(*source).size() : 0;
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(toSeconds(source->missing()), 1 - static_cast<double>(pictures) / 30, 0.05);
    EXPECT_FALSE(source->seek(mediaTime(0.1)).has_value());
  }
  other.join();
}

TEST(FfmpegSource, PacketsNeedAPort) {
  for (const char* url : {"udp://@:0", "udp://:0", "udp://@", "udp://", "udp://[::1]", "udp://127.0.0.1:70000",
                          "udp://127.0.0.1:5x", "rtp://@:0", "rtp://127.0.0.1?ttl=1", "srt://:-1"}) {
    EXPECT_THAT(openErrorOf(url).message, HasSubstr("a port from 1 to 65535")) << url;
  }
  for (const char* url : {"udp://@:1234", "udp:@:1234", "udp://[::1]:65535?pkt_size=1316", "srt://localhost:9000/",
                          "rtp://127.0.0.1:1?a=b:0", "udp://127.0.0.1?localport=1234", "udp://@:1234&reuse=1"}) {
    EXPECT_TRUE(ffmpeg::parseAddress(url)) << url;
  }
}

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
        std::string("udp://127.0.0.1:15006"), std::string("srt://127.0.0.1:9"), std::string("rtp://127.0.0.1:15004")}) {
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
