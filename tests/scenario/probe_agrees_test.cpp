// SPDX-License-Identifier: Apache-2.0
// What `relievo probe` prints about films that ffmpeg made, compared with ffprobe.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using nlohmann::json;
using test::ClipTrack;
using test::makeClip;
using testing::HasSubstr;
using testing::Not;

bool shell(const std::string& command) {
  return std::system((command + " </dev/null").c_str()) == 0;  // NOLINT(bugprone-command-processor): the test's command
}

class ProbeAgrees : public testing::Test {
 protected:
  void SetUp() override {
    if (!shell("command -v ffmpeg ffprobe >/dev/null")) GTEST_SKIP() << "no ffmpeg: toolchain/setup demo";
  }
  [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }
  // ffmpeg's options, the last of them the output's name.
  std::string film(const std::string& options, const std::string& name) const {
    EXPECT_TRUE(shell("ffmpeg -y -v error " + options + " " + at(name))) << options;
    return at(name);
  }
  [[nodiscard]] json ffprobe(const std::string& path) const {
    EXPECT_TRUE(
        shell("ffprobe -v error -of json -show_streams -show_chapters -show_format '" + path + "' >" + at("said")));
    std::ifstream file(at("said"));
    return json::parse(std::string(std::istreambuf_iterator<char>(file), {}), nullptr, false);
  }
  [[nodiscard]] json relievo(const std::string& path) const {
    const auto said = test::runProgram("relievo probe --json " + path, at(""));
    EXPECT_EQ(said.exit_code, 0) << said.err;
    return json::parse(said.out, nullptr, false);
  }
  [[nodiscard]] std::string text(const std::string& path) const {
    return test::runProgram("relievo probe " + path, at("")).out;
  }
  // Every field that both programs print is the same.
  void expectAgreement(const std::string& path) const {
    const json theirs = ffprobe(path), ours = relievo(path);
    ASSERT_EQ(ours["tracks"].size(), theirs["streams"].size()) << path;
    const std::pair<const char*, const char*> fields[] = {{"codec", "codec_name"},
                                                          {"width", "width"},
                                                          {"height", "height"},
                                                          {"pixel_format", "pix_fmt"},
                                                          {"average_rate", "avg_frame_rate"},
                                                          {"base_rate", "r_frame_rate"},
                                                          {"sample_aspect_ratio", "sample_aspect_ratio"},
                                                          {"field_order", "field_order"},
                                                          {"primaries", "color_primaries"},
                                                          {"transfer", "color_transfer"},
                                                          {"channels", "channels"},
                                                          {"channel_layout", "channel_layout"}};
    int compared = 0;
    for (std::size_t i = 0; i < ours["tracks"].size(); ++i) {
      const json& own = ours["tracks"][i];
      const json& other = theirs["streams"][i];
      for (const auto& [key, word] : fields) {
        if (!own.contains(key) || !other.contains(word) || own[key] == "" || other[word] == "unknown") continue;
        EXPECT_EQ(own[key], other[word]) << path << " " << i << " " << key;
        ++compared;
      }
      if (other.contains("bits_per_raw_sample") && own.contains("bits")) {
        EXPECT_EQ(std::to_string(own["bits"].get<int>()), other["bits_per_raw_sample"].get<std::string>()) << path;
      }
      if (other.contains("tags") && other["tags"].contains("language")) {
        EXPECT_EQ(own["language"], other["tags"]["language"]) << path;
      }
    }
    EXPECT_GT(compared, 6) << path;
    ASSERT_EQ(ours["chapters"].size(), theirs["chapters"].size());
    EXPECT_NEAR(ours["duration_s"].get<double>(), std::stod(theirs["format"]["duration"].get<std::string>()), 0.001)
        << path;
  }

  test::TemporaryFolder folder_;
};

TEST_F(ProbeAgrees, OnRatesFieldsAspectsColoursAndLayouts) {
  const std::string source = "-f lavfi -i testsrc=s=96x64:r=30000/1001:d=1 ";
  for (const char* ending : {"mkv", "mp4", "mov", "ts", "avi"}) {
    expectAgreement(film(source + "-c:v libx264 -pix_fmt yuv420p", std::string("ntsc.") + ending));
    EXPECT_THAT(text(at(std::string("ntsc.") + ending)), HasSubstr(", 29.97 frames a second")) << ending;
  }
  expectAgreement(film(source +
                           "-vf setsar=16/15,setparams=color_primaries=bt2020:color_trc=smpte2084:colorspace=bt2020nc "
                           "-c:v libx264 -pix_fmt yuv422p10le -flags +ildct+ilme -x264-params tff=1",
                       "hdr.mp4"));
  const std::string hdr = text(at("hdr.mp4"));
  for (const char* words : {"yuv422p10le of 10 bits", "interlaced, top field first", "sample aspect 16:15",
                            "primaries bt2020", "transfer smpte2084", "made of its first field", "HDR (PQ)"}) {
    EXPECT_THAT(hdr, HasSubstr(words));
  }
}

TEST_F(ProbeAgrees, OnTracksLanguagesAndChapters) {
  std::ofstream(at("words.srt")) << "1\n00:00:00,100 --> 00:00:00,900\nhello\n";
  std::ofstream(at("meta")) << ";FFMETADATA1\n[CHAPTER]\nTIMEBASE=1/1000\nSTART=0\nEND=400\ntitle=One\n"
                               "[CHAPTER]\nTIMEBASE=1/1000\nSTART=400\nEND=1000\ntitle=Two\n";
  const std::string path = film(
      "-f lavfi -i testsrc=s=96x64:d=1 -f lavfi -i sine=d=1 -f lavfi -i aevalsrc=0\\|0\\|0\\|0\\|0\\|0:d=1:c=5.1 -i " +
          at("words.srt") + " -i " + at("meta") +
          " -map 0 -map 1 -map 2 -map 3 -map_metadata 4 -c:v libx264 -pix_fmt yuv420p -c:a flac -c:s srt "
          "-metadata:s:a:0 language=deu -metadata:s:a:1 language=fra -metadata:s:s:0 language=eng",
      "film.mkv");
  expectAgreement(path);
  const std::string said = text(path);
  for (const char* words :
       {"1 sound flac 44100 Hz, mono, language deu", "2 sound flac 44100 Hz, 5.1, language fra",
        "3 subtitles subrip, language eng", "chapter 0.000 to 0.400 s \"One\"", "chapter 0.400 to 1.000 s \"Two\""}) {
    EXPECT_THAT(said, HasSubstr(words));
  }
}

// FFmpeg knows the size of such pictures only after it has decoded one.
TEST_F(ProbeAgrees, OnTheSizesOfSinglePictures) {
  for (const char* name : {"a.tif", "a.jpg", "a.png", "a.bmp"}) {
    const json track = relievo(film("-f lavfi -i testsrc=s=48x32 -frames:v 1", name))["tracks"][0];
    EXPECT_EQ(track["width"], 48) << name;
    EXPECT_EQ(track["height"], 32) << name;
  }
}

// A third of each picture, at its lower end.
TEST_F(ProbeAgrees, OnTheShareOfHoles) {
  ClipTrack depth{.codec = "png", .pix_fmt = "gray16be", .width = 60, .height = 60, .frames = 2};
  depth.sample = [](int, int c, int r, int) { return r >= 40 ? 0u : 1000u + 10 * static_cast<unsigned>(r) + c % 7; };
  makeClip(at("%02d.png"), {depth});
  EXPECT_NEAR(relievo(at("%02d.png"))["depth"]["holes"].get<double>(), 1.0 / 3, 1e-9);
}

TEST_F(ProbeAgrees, OnVariableRatesAndStills) {
  // Of 60 pictures a second 1 in 2 for a second, then 1 in 6: 30, then 10.
  const std::string path = film(
      "-f lavfi -i testsrc=s=96x64:r=60:d=3 -vf \"select='if(lt(n\\,60)\\,not(mod(n\\,2))\\,not(mod(n\\,6)))'\" -vsync "
      "vfr "
      "-c:v libx264 -pix_fmt yuv420p -video_track_timescale 60000",
      "vfr.mp4");
  expectAgreement(path);
  const json rate = relievo(path)["rate"];
  EXPECT_TRUE(rate["variable"]);
  EXPECT_NEAR(rate["range"][0].get<double>(), 10, 0.01);
  EXPECT_NEAR(rate["range"][1].get<double>(), 30, 0.01);
  EXPECT_NEAR(rate["average"].get<double>(), 49 / (1 + 19.0 / 10), 0.2) << "50 pictures, 49 steps";
  film("-f lavfi -i testsrc=s=96x64:d=1 -frames:v 1", "one.png");
  EXPECT_THAT(text(at("one.png")),
              testing::AllOf(HasSubstr("color   png 96 x 64, one picture\n"), Not(HasSubstr("frames"))));
}

TEST_F(ProbeAgrees, OnRotationByEveryQuarterTurn) {
  for (const int turn : {0, 90, 180, 270}) {
    ClipTrack track{.pix_fmt = "yuv420p", .frames = 3};
    track.rotation = turn;
    makeClip(at("turned.mov"), {track});
    const json said = relievo(at("turned.mov"));
    EXPECT_EQ(said["tracks"][0]["rotation"], turn);
    EXPECT_EQ(said["color"]["width"], turn % 180 == 0 ? 64 : 48);
    const json theirs = ffprobe(at("turned.mov"))["streams"][0];
    const int anticlockwise = turn == 0 ? 0 : theirs["side_data_list"][0]["rotation"].get<int>();
    EXPECT_EQ((360 - anticlockwise) % 360, turn);
  }
}

}  // namespace
}  // namespace relievo
