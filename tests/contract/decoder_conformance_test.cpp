// SPDX-License-Identifier: Apache-2.0
// Streams of every kind through each software decoder, compared with the pictures of FFmpeg's program; and JVT's
// conformance streams, compared with their MD5 sums, where RELIEVO_CONFORMANCE names a folder that holds them. Their
// licence does not allow copies here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "tests/contract/decoded_film.h"
#include "tests/contract/raw_pictures.h"
#ifdef RELIEVO_GSTREAMER
#include "drivers/gstreamer/gstreamer.h"
#include "tests/support/device/gstreamer_element.h"
#endif

namespace relievo::test {
namespace {

namespace fs = std::filesystem;

struct Backend {
  const char* name;
  std::function<std::unique_ptr<VideoDecoder>(const std::string& codec)> make;
};
std::vector<Backend> backends() {
  std::vector<Backend> all{{"ffmpeg", [](const std::string&) { return makeFfmpegDecoder(); }}};
#ifdef RELIEVO_GSTREAMER
  static const bool prepared = [] {
    keepGstreamerListAt(RELIEVO_BIN_DIR "/../tests/gstreamer.list");
    return true;
  }();
  (void)prepared;
  all.push_back({"gstreamer", [](const std::string& codec) {
                   return makeGstreamerDecoder(codec == "hevc"         ? "avdec_h265"
                                               : codec == "mpeg2video" ? "avdec_mpeg2video"
                                                                       : "avdec_h264");
                 }});
#endif
  return all;
}

struct Decoded {
  std::vector<std::string> sums;  // of the pictures
  std::string whole;              // of all of them in one file
  bool in_order = true;
  std::uint64_t damaged = 0;
  std::optional<Error> error;
};
Decoded decode(const Backend& backend, const Film& film) {
  const auto decoder = backend.make(film.stream.codec);
  Decoded decoded;
  Md5 all;
  MediaTime last = MediaTime::min();
  if (auto opened = decoder->open(film.stream); !opened) {
    decoded.error = opened.error();
    return decoded;
  }
  std::vector<Shown> shown;
  const auto played = feedTo(*decoder, film, 0, film.packets.size(), shown, [&](const Frame& frame) {
    std::vector<std::uint8_t> bytes;
    appendRaw(frame, bytes);
    all.add(bytes);
    Md5 one;
    one.add(bytes);
    decoded.sums.push_back(one.sum());
    decoded.in_order = decoded.in_order && frame.pts > last;
    last = frame.pts;
  });
  if (!played) decoded.error = played.error();
  decoded.damaged = decoder->damaged();
  decoded.whole = all.sum();
  return decoded;
}

struct Kind {
  const char *name, *input, *coding;
  int pictures;
  const char* filter = "null";  // for the program, before it compares
};

// HEVC with several slices a picture is left out: with two threads or more that decode a picture each, FFmpeg 5.1
// sometimes decodes it wrongly, and so does its program.
constexpr const char* kMoving = "testsrc2=s=128x96:r=25:d=2";
const Kind kKinds[] = {
    {"pyramid.mkv", kMoving, "-c:v libx264 -bf 7 -x264-params b-pyramid=normal:b-adapt=0:ref=6:keyint=25", 50},
    {"pyramid.ts", kMoving, "-c:v libx264 -bf 7 -x264-params b-pyramid=strict:b-adapt=0:ref=6:keyint=25", 50},
    {"open.mkv", kMoving, "-c:v libx264 -bf 3 -x264-params open-gop=1:keyint=12:scenecut=0", 50},
    {"weighted.mp4", "testsrc2=s=128x96:r=25:d=2,fade=in:0:40", "-c:v libx264 -x264-params weightp=2:weightb=1:ref=4",
     50},
    {"cavlc.mkv", kMoving, "-c:v libx264 -x264-params cabac=0:slices=4:8x8dct=0", 50},
    {"refresh.mkv", kMoving, "-c:v libx264 -x264-params intra-refresh=1:keyint=20", 50},
    {"baseline.mp4", kMoving, "-c:v libx264 -profile:v baseline", 50},
    {"lossless.mkv", kMoving, "-c:v libx264 -qp 0 -pix_fmt yuv444p", 50},
    {"odd.mkv", "testsrc2=s=126x94:r=25:d=1", "-c:v libx264", 25},
    {"gray.mkv", kMoving, "-c:v libx264 -pix_fmt gray", 50},
    {"interlaced.ts", kMoving, "-c:v libx264 -flags +ilme+ildct -x264-params tff=1:bframes=2", 50},
    {"interlaced.mkv", kMoving, "-c:v mpeg2video -flags +ilme+ildct -bf 2 -g 12", 50},
    {"ten.mkv", kMoving, "-c:v libx264 -pix_fmt yuv420p10le", 50},
    {"ten422.mkv", kMoving, "-c:v libx264 -pix_fmt yuv422p10le -bf 3", 50},
    {"hevc.mkv", kMoving, "-c:v libx265 -x265-params log-level=none:bframes=8:b-pyramid=1:b-adapt=0:keyint=25", 50},
    {"hevcopen.ts", kMoving, "-c:v libx265 -x265-params log-level=none:open-gop=1:keyint=12:bframes=4:scenecut=0", 50},
    {"hevcten.mp4", kMoving, "-c:v libx265 -pix_fmt yuv420p10le -x265-params log-level=none:amp=1:rect=1", 50},
    {"hevc444.mkv", kMoving, "-c:v libx265 -pix_fmt yuv444p10le -x265-params log-level=none", 50},
    {"hevcgray.mkv", kMoving, "-c:v libx265 -pix_fmt gray -x265-params log-level=none", 50, "extractplanes=y"},
    {"hevclossless.mkv", kMoving, "-c:v libx265 -x265-params log-level=none:lossless=1:wpp=1", 50},
};

std::string makeStream(const Kind& kind, const TemporaryFolder& folder) {
  runFfmpeg(std::string("-f lavfi -i ") + kind.input + " " +
                (std::string(kind.coding).find("-pix_fmt") == std::string::npos ? "-pix_fmt yuv420p " : "") +
                kind.coding + " " + (folder / kind.name),
            folder / "said.txt");
  return folder / kind.name;
}

TEST(DecoderConformance, EveryKindOfStreamIsDecodedAsFfmpegsProgramDoes) {
  const TemporaryFolder folder;
  for (const Kind& kind : kKinds) {
    SCOPED_TRACE(kind.name);
    const std::string path = makeStream(kind, folder);
    const auto expected = sumsByFfmpeg(path, folder, kind.filter);
    ASSERT_EQ(expected.size(), static_cast<std::size_t>(kind.pictures));
    const Film film(path);
    for (const Backend& backend : backends()) {
      SCOPED_TRACE(backend.name);
      const Decoded decoded = decode(backend, film);
      EXPECT_FALSE(decoded.error) << decoded.error->message;
      EXPECT_EQ(decoded.sums, expected);
      EXPECT_TRUE(decoded.in_order);
      EXPECT_EQ(decoded.damaged, 0U);
    }
  }
}

TEST(DecoderConformance, TheSizeMayChange) {
  const TemporaryFolder folder;
  for (const std::string codec : {"libx264", "libx265"}) {
    SCOPED_TRACE(codec);
    const std::string coding = "-c:v " + codec + (codec == "libx265" ? " -x265-params log-level=none " : " ");
    std::ofstream joined(folder / (codec + ".ts"), std::ios::binary);
    int part = 0;
    for (const char* size : {"128x96", "96x144", "192x64", "128x96"}) {
      runFfmpeg(std::string("-f lavfi -i testsrc2=r=25:d=1:s=") + size + " -pix_fmt yuv420p " + coding +
                    "-output_ts_offset " + std::to_string(++part) + " " + (folder / "part.ts"),
                folder / "said.txt");
      joined << std::ifstream(folder / "part.ts", std::ios::binary).rdbuf();
    }
    joined.close();
    const auto expected = sumsByFfmpeg(folder / (codec + ".ts"), folder);
    ASSERT_EQ(expected.size(), 100U);
    const Film film(folder / (codec + ".ts"));
    for (const Backend& backend : backends()) {
      SCOPED_TRACE(backend.name);
      const Decoded decoded = decode(backend, film);
      EXPECT_FALSE(decoded.error);
      EXPECT_EQ(decoded.sums, expected);
    }
  }
}

// The second of four groups of pictures is damaged: what the others hold is exact, and the film ends as any other.
TEST(DecoderConformance, ErrorsEndWithTheirGroupOfPictures) {
  const TemporaryFolder folder;
  for (const char* codec : {"libx264 -x264-params keyint=24:scenecut=0",
                            "libx265 -x265-params log-level=none:keyint=24:scenecut=0:open-gop=0"}) {
    SCOPED_TRACE(codec);
    runFfmpeg(std::string("-f lavfi -i testsrc2=s=128x96:r=24:d=4 -pix_fmt yuv420p -c:v ") + codec + " " +
                  (folder / "whole.mkv"),
              folder / "said.txt");
    const auto expected = sumsByFfmpeg(folder / "whole.mkv", folder);
    ASSERT_EQ(expected.size(), 96U);
    Film film(folder / "whole.mkv");
    ASSERT_TRUE(film.packets.at(24).keyframe && film.packets.at(48).keyframe);
    for (std::size_t i = 26; i < 46; i += 3) {  // in the middle of a slice's data
      Packet& packet = film.packets[i];
      const auto bytes = std::make_shared<std::vector<std::uint8_t>>(packet.data, packet.data + packet.bytes);
      for (std::size_t at = packet.bytes / 2; at < packet.bytes; ++at) (*bytes)[at] ^= 0x5aU;
      packet.data = bytes->data();
      packet.owner = bytes;
    }
    for (const Backend& backend : backends()) {
      SCOPED_TRACE(backend.name);
      const Decoded decoded = decode(backend, film);
      EXPECT_FALSE(decoded.error) << decoded.error->message;
      ASSERT_GE(decoded.sums.size(), 72U);
      EXPECT_LE(decoded.sums.size(), 96U);
      EXPECT_TRUE(std::equal(expected.begin(), expected.begin() + 24, decoded.sums.begin()));
      EXPECT_TRUE(std::equal(expected.end() - 48, expected.end(), decoded.sums.end() - 48));
      EXPECT_TRUE(decoded.damaged > 0 || decoded.sums != expected);
    }
  }
}

// ---- streams of a folder

// The MD5 sums of a stream's pictures, from the files beside it: sums, or the decoded pictures themselves.
std::vector<std::string> knownSums(const fs::path& stream) {
  std::vector<std::string> sums;
  const std::string stem = stream.stem().string();
  for (const auto& entry : fs::directory_iterator(stream.parent_path())) {
    const fs::path& path = entry.path();
    if (path == stream || !path.filename().string().starts_with(stem)) continue;
    std::ifstream file(path, std::ios::binary);
    if (path.extension() == ".yuv") {
      Md5 md5;
      md5.add({std::istreambuf_iterator<char>(file), {}});
      sums.push_back(md5.sum());
    } else if (path.extension() == ".md5") {
      for (std::string word; file >> word;) {
        std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::tolower(c); });
        if (word.size() == 32 && word.find_first_not_of("0123456789abcdef") == std::string::npos) sums.push_back(word);
      }
    }
  }
  return sums;
}

bool isStream(const fs::path& path) {
  constexpr const char* kEndings[] = {".jsv", ".jvt",  ".264", ".h264", ".avc", ".26l",
                                      ".bit", ".bits", ".bin", ".hevc", ".265"};
  return std::ranges::find(kEndings, path.extension().string()) != std::end(kEndings);
}

// A stream of packets alone has no times. Each gets that of its picture's place in FFmpeg's order, since a picture is
// known by its packet's time.
Film timedFilm(const std::string& path) {
  constexpr auto kPeriod = std::chrono::milliseconds(40);
  Film film(path);
  const auto time = [&](std::size_t i) { return MediaTime(kPeriod * static_cast<std::int64_t>(i)); };
  for (std::size_t i = 0; i < film.packets.size(); ++i) {
    film.packets[i].pts = time(i);
    film.packets[i].dts.reset();
  }
  std::vector<std::optional<MediaTime>> times(film.packets.size());
  std::size_t place = 0;
  for (const Shown& shown : bySoftware(film)) {
    const auto packet = static_cast<std::size_t>(shown.pts.time_since_epoch() / kPeriod);
    if (packet < times.size()) times[packet] = time(place++);
  }
  for (std::size_t i = 0; i < times.size(); ++i) {  // a packet with a second field has no picture of its own
    film.packets[i].pts =
        times[i] ? *times[i] : MediaTime(i > 0 ? *film.packets[i - 1].pts + Duration(1) : MediaTime{});
  }
  return film;
}

struct Verdict {
  int passed = 0;
  std::vector<std::string> failed, without_sum;  // "stream, back end: why"
};
Verdict judge(const std::string& folder) {
  Verdict verdict;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!isStream(entry.path())) continue;
    const auto known = knownSums(entry.path());
    if (known.empty()) {
      verdict.without_sum.push_back(entry.path().filename());
      continue;
    }
    const Film film = timedFilm(entry.path());
    for (const Backend& backend : backends()) {
      const Decoded decoded = decode(backend, film);
      const bool right = !decoded.error && std::ranges::find(known, decoded.whole) != known.end();
      verdict.passed += right ? 1 : 0;
      if (right) continue;
      verdict.failed.push_back(entry.path().filename().string() + ", " + backend.name + ": " +
                               (decoded.error ? decoded.error->message : "other pictures"));
    }
  }
  return verdict;
}

TEST(DecoderConformance, AFolderOfStreamsIsJudgedByTheSumsBesideThem) {
  const TemporaryFolder folder;
  const auto make = [&](const std::string& name, const std::string& coding) {
    const std::string pictures = "-f lavfi -i testsrc2=s=112x96:r=25:d=1 ";
    runFfmpeg(pictures + coding + " " + (folder / name), folder / "said.txt");
    runFfmpeg("-i " + (folder / name) + " -f rawvideo -fps_mode passthrough " + (folder / "raw"), folder / "said.txt");
    std::ifstream raw(folder / "raw", std::ios::binary);
    Md5 md5;
    md5.add({std::istreambuf_iterator<char>(raw), {}});
    fs::rename(folder / "raw", folder / "pictures");
    return md5.sum();
  };
  const std::string first = make("A_1.264", "-c:v libx264 -pix_fmt yuv420p -bf 3 -f h264");
  std::ofstream(folder / "A_1_yuv.md5") << first << " *A_1.yuv\n";
  (void)make("B_1.avc", "-c:v libx264 -pix_fmt yuv420p -profile:v baseline -f h264");
  fs::copy_file(folder / "pictures", folder / "B_1.yuv");
  std::string third = make("C_1.bit", "-c:v libx265 -pix_fmt yuv420p10le -x265-params log-level=none -f hevc");
  std::ranges::transform(third, third.begin(), [](unsigned char c) { return std::toupper(c); });
  std::ofstream(folder / "C_1.md5") << "MD5 (C_1.yuv) = " << third << "\n";
  (void)make("D_1.264", "-c:v libx264 -pix_fmt yuv420p -qp 40 -f h264");
  std::ofstream(folder / "D_1.md5") << first << "\n";  // of another one
  (void)make("E_1.264", "-c:v libx264 -pix_fmt yuv420p -f h264");
  const Verdict verdict = judge(fs::path(folder / "A_1.264").parent_path());
  const auto count = static_cast<int>(backends().size());
  EXPECT_EQ(verdict.passed, 3 * count) << testing::PrintToString(verdict.failed);
  EXPECT_EQ(verdict.failed.size(), static_cast<std::size_t>(count));
  EXPECT_THAT(verdict.failed, testing::Each(testing::MatchesRegex("D_1.264, .*: other pictures")));
  EXPECT_THAT(verdict.without_sum, testing::ElementsAre("E_1.264"));
}

TEST(DecoderConformance, JvtsStreamsHaveTheirSums) {
  const char* const folder = std::getenv("RELIEVO_CONFORMANCE");
  if (folder == nullptr) GTEST_SKIP() << "RELIEVO_CONFORMANCE names no folder of conformance streams";
  const Verdict verdict = judge(folder);
  for (const std::string& name : verdict.without_sum) std::printf("no sum beside it: %s\n", name.c_str());
  std::printf("%d passed\n", verdict.passed);
  EXPECT_GT(verdict.passed, 0);
  EXPECT_THAT(verdict.failed, testing::IsEmpty());
}

}  // namespace
}  // namespace relievo::test
