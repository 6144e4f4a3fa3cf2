// SPDX-License-Identifier: Apache-2.0
// Placement of key frames, the words for paintings, and the author's messages during and after its work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "app/author/material/painting.h"
#include "app/author/package/key_frames.h"
#include "app/author/package/output.h"
#include "app/author/package/source_notes.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<int> keysOf(int frames, double fps, const std::function<bool(int)>& depth_is_new) {
  KeyFrames keys;
  std::vector<int> found;
  for (int k = 0; k < frames; ++k) {
    if (keys.isDue(mediaTime(k / fps), depth_is_new(k))) found.push_back(k);
  }
  return found;
}

TEST(AuthorKeyFrames, AreASecondApart) {
  EXPECT_THAT(keysOf(91, 30, [](int) { return true; }), ElementsAre(0, 30, 60, 90));
  EXPECT_THAT(keysOf(60, 24, [](int) { return true; }), ElementsAre(0, 24, 48));
  // 23.976 frames/s: the first picture at or after a second is the 24th.
  EXPECT_THAT(keysOf(60, 24000.0 / 1001, [](int) { return true; }), ElementsAre(0, 24, 48));
}

TEST(AuthorKeyFrames, ComeWithTheContainersRounding) {
  KeyFrames keys;
  std::vector<int> found;
  for (int k = 0; k <= 60; ++k) {  // 30 frames a second, times cut to milliseconds: 999 ms at worst
    const auto ms = std::chrono::milliseconds(static_cast<int>(k * 1000 / 30.0 - 0.3));
    if (keys.isDue(MediaTime(ms), true)) found.push_back(k);
  }
  EXPECT_THAT(found, ElementsAre(0, 30, 60));
}

TEST(AuthorKeyFrames, WaitForADepthPicture) {
  // Depth with every fourth colour picture: picture 30 has none, 32 has.
  EXPECT_THAT(keysOf(70, 30, [](int k) { return k % 4 == 0; }), ElementsAre(0, 32, 64));
}

TEST(AuthorKeyFrames, AreAtCuts) {
  KeyFrames keys;
  std::vector<int> found;
  for (int k = 0; k < 80; ++k) {  // cuts at 40 and at 50; there is no new depth picture at 50
    if (keys.isDue(mediaTime(k / 30.0), k != 50, k == 40 || k == 50)) found.push_back(k);
  }
  EXPECT_THAT(found, ElementsAre(0, 30, 40, 70));
}

TEST(AuthorKeyFrames, DoNotWaitForEver) {
  EXPECT_THAT(keysOf(125, 30, [](int k) { return k == 0; }), ElementsAre(0, 61, 122));
}

TEST(AuthorProgress, TellsFramesRateAndTimeLeft) {
  EXPECT_EQ(progressText(100, 400, std::chrono::seconds(4)), "100/400 frames, 25.0 frames/s, 0:12 left");
  EXPECT_EQ(progressText(10, 2010, std::chrono::seconds(1)), "10/2010 frames, 10.0 frames/s, 3:20 left");
}

TEST(AuthorProgress, LeavesOutWhatIsNotKnown) {
  EXPECT_EQ(progressText(100, std::nullopt, std::chrono::seconds(4)), "100 frames, 25.0 frames/s");
  EXPECT_EQ(progressText(1, 400, Duration(0)), "1/400 frames");
  // A container's length that turned out too short is ignored.
  EXPECT_EQ(progressText(401, 400, std::chrono::seconds(10)), "401 frames, 40.1 frames/s");
}

TEST(AuthorNotes, SayThatTheMaterialTrackIsLeftOut) {
  FilmInfo info;
  FilmFormat format;
  const auto notes = [&] { return sourceNotes({}, info, {}, format, {}); };
  EXPECT_THAT(notes(), IsEmpty());
  info.material_scale.stiffness_n_per_mm = 1.0;
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("material track is left out")));
  format.material_width = 320;
  EXPECT_THAT(notes(), IsEmpty());
}

TEST(AuthorOutput, IsCheckedBeforeAnyWork) {
  const test::TemporaryFolder folder;
  const auto refused = [&](OutputOptions output) {
    if (output.path.starts_with("in/")) output.path = folder / output.path.substr(3);
    const auto checked = checkOutput(output);
    return checked ? std::string() : std::string(checked.error().message);
  };
  for (const char* path : {"in/a.mkv", "in/a.MP4", "in/a.ts", "in/a.m3u8", "udp://127.0.0.1:5000"}) {
    EXPECT_EQ(refused({.path = path}), "") << path;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / "")) << "trying leaves nothing behind";
  for (const char* path : {"in/none/a.mkv", "in/none/a.ts", "in/none/a.m3u8"}) {
    EXPECT_THAT(refused({.path = path}), HasSubstr("its folder does not exist")) << path;
  }
  const auto preview = checkPreview({.path = "a.mkv", .preview = folder / "none/a.png"});
  EXPECT_EQ(preview.error().code, ErrorCode::NotFound);
  EXPECT_THAT(refused({.path = "a.avi"}), HasSubstr(".m3u8"));
  EXPECT_EQ(refused({.path = "in/a.mkv", .depth = {.codec = VideoCodec::Ffv1, .bits = 16}}), "");
  EXPECT_THAT(refused({.path = "in/a.ts", .depth = {.codec = VideoCodec::Ffv1}}), HasSubstr("write a .mkv"));
  EXPECT_THAT(refused({.path = "in/a.mkv", .depth = {.bits = 12}}), HasSubstr("h264 has 8 and 10"));
  for (const char* path : {"udp://[::1]:65535?pkt_size=1316", "srt://localhost:9000/"}) {
    EXPECT_EQ(refused({.path = path}), "") << path;
  }
  for (const char* path : {"udp://127.0.0.1:99999", "udp://127.0.0.1:0", "udp://127.0.0.1:-1", "udp://127.0.0.1:5x",
                           "udp://127.0.0.1", "udp://[::1]", "srt://"}) {
    EXPECT_THAT(refused({.path = path}), HasSubstr("from 1 to 65535")) << path;
  }
}

TEST(AuthorSummary, TellsTracksCodesAndWhatWasDone) {
  AuthorSummary summary;
  summary.format.color_width = 640;
  summary.format.color_height = 480;
  summary.format.depth_width = 320;
  summary.format.depth_height = 240;
  summary.format.depth.codec = VideoCodec::Hevc;
  summary.format.depth.bits = 10;
  summary.format.depth_tags = {{"DEPTH_LAW", "inverse"}, {"DEPTH_NEAR", "500"}, {"DEPTH_FAR", "4000"}};
  summary.frame_period = std::chrono::milliseconds(40);
  // 50 pictures of 40 ms are 2 s; 250,000 bytes are 1000 kbit/s.
  summary.totals.color = {50, 250'000, MediaTime{}, MediaTime(std::chrono::milliseconds(1960))};
  summary.totals.depth = {50, 25'000, MediaTime{}, MediaTime(std::chrono::milliseconds(1960))};
  summary.totals.file_bytes = 2'750'000;
  summary.codes.of_code[3] = 10;
  summary.codes.of_code[200] = 80;
  summary.codes.holes = 10;
  summary.codes.samples = 100;
  summary.notes = {"16 bits rescaled to 8"};

  const std::string text = toText("film.mkv", summary);
  EXPECT_THAT(text, HasSubstr("film.mkv: 2.00 s, 2.75 MB"));
  EXPECT_THAT(text, HasSubstr("640x480"));
  EXPECT_THAT(text, HasSubstr("320x240"));
  EXPECT_THAT(text, HasSubstr(" 1000 kbit/s"));
  EXPECT_THAT(text, HasSubstr(" 100 kbit/s"));
  EXPECT_THAT(text, HasSubstr("8 bits, 3 .. 200, 2 of them used; holes 10.0 %"));
  EXPECT_THAT(text, HasSubstr("HEVC 4:0:0, 10 bits"));
  EXPECT_THAT(text, HasSubstr("inverse law"));
  EXPECT_THAT(text, HasSubstr("near 500 mm, far 4000 mm"));
  EXPECT_THAT(text, HasSubstr("note: 16 bits rescaled to 8"));
}

TEST(AuthorSummary, SaysWhereEnhancementMakesTheDepthWorse) {
  AuthorSummary summary;
  summary.enhancement = Enhancement::Median;
  // Levels of 255 in a box 40 mm deep: .0157 mm, .0471 mm.
  summary.enhanced = {.error_before = 0.1, .error_after = 0.3};
  EXPECT_THAT(toText("a.mkv", summary), HasSubstr("the depth gets worse: leave out --enhance"));
  summary.enhanced = {.error_before = 0.3, .error_after = 0.1};
  EXPECT_THAT(toText("a.mkv", summary), testing::Not(HasSubstr("worse")));
  summary.enhanced = {.error_before = 0.1, .error_after = 0.102};
  EXPECT_THAT(toText("a.mkv", summary), testing::Not(HasSubstr("worse"))) << "the same as far as it is told";
}

TEST(Paintings, HaveTimesThatIncrease) {
  EXPECT_EQ(parsePaintings("paint.png"), (std::vector<Painting>{{"paint.png", 0}}));
  EXPECT_EQ(parsePaintings("0=a.png,12.5=b=2.png"), (std::vector<Painting>{{"a.png", 0}, {"b=2.png", 12.5}}));
  for (const char* const wrong : {"0=a.png,b.png", "0=a.png,", "0=", "-1=a.png", "nan=a.png", "1s=a.png"}) {
    ASSERT_FALSE(parsePaintings(wrong)) << wrong;
    EXPECT_THAT(parsePaintings(wrong).error().message, HasSubstr("SECONDS=FILE")) << wrong;
  }
  for (const char* const wrong : {"2=a.png,1=b.png", "1=a.png,1=b.png"}) {
    ASSERT_FALSE(parsePaintings(wrong)) << wrong;
    EXPECT_THAT(parsePaintings(wrong).error().message, HasSubstr("increase")) << wrong;
  }
}

}  // namespace
}  // namespace relievo
