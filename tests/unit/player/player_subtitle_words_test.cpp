// SPDX-License-Identifier: Apache-2.0
// Subtitles at their times, each once; and the file of a screenshot.
#include "app/player/screen/subtitle_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "app/player/png_file.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using std::chrono::seconds;

constexpr TextFrame kFrame{.width = 640, .height = 360};

Subtitle said(const std::string& words, double begin_s, double end_s) {
  static const auto styles = std::make_shared<const std::string>("[Script Info]\nPlayResX: 640\nPlayResY: 360\n");
  return {.begin = mediaTime(begin_s),
          .end = mediaTime(end_s),
          .lines = {"0,0,Default,,0,0,0,," + words},
          .styles = styles};
}

int inkAt(SubtitleWords& words, double time_s) {
  words.draw(kFrame, mediaTime(time_s));
  int ink = 0;
  for (const TextPicture& picture : words.pictures()) {
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) ink += picture.rgba[i] > 128;
  }
  return ink;
}

#define FONT_OR_SKIP() \
  if (!AssText::create()) GTEST_SKIP() << "no font here"

TEST(SubtitleWords, AreShownAtTheirTimesAlone) {
  FONT_OR_SKIP();
  SubtitleWords words;
  words.add(said("hello", 1, 2));
  EXPECT_EQ(inkAt(words, 0.99), 0);
  EXPECT_GT(inkAt(words, 1), 50);
  EXPECT_GT(inkAt(words, 1.99), 50);
  EXPECT_EQ(inkAt(words, 2), 0);
  words.show(false);
  EXPECT_EQ(inkAt(words, 1.5), 0);
  words.show(true);
  EXPECT_GT(inkAt(words, 1.5), 50);
}

TEST(SubtitleWords, AreShownLaterByTheirDelay) {
  FONT_OR_SKIP();
  SubtitleWords words;
  words.add(said("hello", 1, 2));
  words.changeDelay(seconds(3));
  words.changeDelay(-seconds(1));
  EXPECT_EQ(words.delay(), seconds(2));
  EXPECT_EQ(inkAt(words, 2.99), 0);
  EXPECT_GT(inkAt(words, 3), 50);
  EXPECT_EQ(inkAt(words, 4), 0);
}

TEST(SubtitleWords, ALineThatComesAgainAfterASeekIsShownOnce) {
  FONT_OR_SKIP();
  SubtitleWords words;
  words.add(said("hello", 1, 2));
  const int once = inkAt(words, 1.5);
  words.add(said("hello", 1, 2));
  EXPECT_EQ(inkAt(words, 1.5), once);
  words.add(said("two lines", 1, 2));
  EXPECT_GT(inkAt(words, 1.5), once);
  words.forget();
  EXPECT_EQ(inkAt(words, 1.5), 0);
}

TEST(SubtitleWords, PicturesOfWordsLieOnTheFilmsPictureUntilTheNext) {
  SubtitleWords words;
  const SubtitlePicture picture{
      .x = 100, .y = 400, .width = 200, .height = 50, .rgba = std::vector<std::uint8_t>(40000, 255)};
  words.add({.begin = mediaTime(1), .pictures = {picture}, .canvas_width = 1280, .canvas_height = 720});
  words.add({.begin = mediaTime(3)});
  const TextFrame boxed{.width = 640, .height = 480, .aspect = 4.0 / 3, .margin_y = 60};
  EXPECT_TRUE(words.draw(boxed, mediaTime(2)));
  EXPECT_FALSE(words.draw(boxed, mediaTime(2.5))) << "the same";
  ASSERT_EQ(words.pictures().size(), 1u);
  const TextPicture& placed = words.pictures()[0];
  EXPECT_EQ(placed.x, 50);
  EXPECT_EQ(placed.y, 60 + 200);
  EXPECT_EQ(placed.width, 100);
  EXPECT_EQ(placed.cols, 200);
  EXPECT_TRUE(words.draw(boxed, mediaTime(3)));
  EXPECT_TRUE(words.pictures().empty());
}

Subtitle drawn(double begin_s, bool something = true) {
  Subtitle subtitle{.begin = mediaTime(begin_s), .canvas_width = 640, .canvas_height = 360};
  if (something) subtitle.pictures = {{.width = 8, .height = 8, .rgba = std::vector<std::uint8_t>(256, 255)}};
  return subtitle;
}

TEST(SubtitleWords, OfManyPicturesThoseAroundThePlaceWhereTheFilmIsReadAreKept) {
  SubtitleWords words;
  const auto isShownAt = [&](double time_s) {
    words.draw(kFrame, mediaTime(time_s));
    return !words.pictures().empty();
  };
  const auto play = [&](int from_s, int to_s) {
    for (int second = from_s; second < to_s; ++second) {
      words.add(drawn(second));
      words.add(drawn(second + 0.5, false));
      EXPECT_TRUE(isShownAt(second + 0.2)) << second;
      EXPECT_FALSE(isShownAt(second + 0.7)) << second;
    }
  };
  play(0, 100);
  play(20, 100);  // a seek back
}

TEST(SubtitleWords, APictureThatBeginsWhereTheOneBeforeEndsIsShown) {
  for (const bool end_first : {true, false}) {
    SubtitleWords words;
    words.add(drawn(1));
    words.add(drawn(2, !end_first));
    words.add(drawn(2, end_first));
    words.draw(kFrame, mediaTime(2.5));
    EXPECT_EQ(words.pictures().size(), 1u);
  }
}

TEST(SubtitleWords, LettersAndPicturesGrowAndShrink) {
  FONT_OR_SKIP();
  SubtitleWords words;
  words.changeSize(0.5);  // before the first word
  words.add(said("{\\an2}hello", 1, 2));
  ASSERT_TRUE(words.draw(kFrame, mediaTime(1.5)));
  const double large = words.pictures().at(0).width;
  words.changeSize(-0.5);
  ASSERT_TRUE(words.draw(kFrame, mediaTime(1.5)));
  EXPECT_NEAR(large / words.pictures().at(0).width, 1.5, 0.2) << "its outline does not grow as much";
  for (int i = 0; i < 40; ++i) words.changeSize(-0.1);
  EXPECT_DOUBLE_EQ(words.size(), 0.5) << "no smaller";

  SubtitleWords pictures;
  const SubtitlePicture picture{
      .x = 100, .y = 400, .width = 200, .height = 50, .rgba = std::vector<std::uint8_t>(40000, 255)};
  pictures.add({.begin = mediaTime(1), .pictures = {picture}, .canvas_width = 640, .canvas_height = 720});
  pictures.changeSize(0.5);
  ASSERT_TRUE(pictures.draw(kFrame, mediaTime(2)));
  const TextPicture& grown = pictures.pictures().at(0);
  EXPECT_EQ(grown.width, 300);
  EXPECT_EQ(grown.x, 50) << "its middle stays at 200";
  EXPECT_NEAR(grown.y + grown.height, 225, 1) << "its foot stays";
}

// A bar that begins 30 rows above the foot lifts both lines by the same way, and nothing in the upper half.
TEST(SubtitleWords, AreLiftedOverTheBarAndComeDownAgain) {
  FONT_OR_SKIP();
  SubtitleWords words;
  words.add(said("{\\an2\\pos(320,350)}low", 1, 9));
  words.add(said("{\\an2\\pos(320,250)}higher", 1, 9));
  words.add(said("{\\an8\\pos(320,10)}top", 1, 9));
  ASSERT_TRUE(words.draw(kFrame, mediaTime(2)));
  std::vector<int> before;
  int bottom = 0;
  for (const TextPicture& picture : words.pictures()) {
    before.push_back(picture.y);
    bottom = std::max(bottom, picture.y + picture.height);
  }
  ASSERT_EQ(before.size(), 3u);
  const SubtitleRoom room{.down = 330.0 / 360};
  EXPECT_TRUE(words.draw(kFrame, mediaTime(2), room));
  EXPECT_FALSE(words.draw(kFrame, mediaTime(2), room)) << "the same";
  const int up = bottom - 330;
  ASSERT_GT(up, 5);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(words.pictures()[i].y, before[i] - (before[i] > 180 ? up : 0));
  }
  EXPECT_TRUE(words.draw(kFrame, mediaTime(2)));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(words.pictures()[i].y, before[i]);
}

TEST(SubtitleWords, StayAwayUnderAPageThatCoversTheFilm) {
  FONT_OR_SKIP();
  SubtitleWords words;
  words.add(said("hello", 1, 9));
  ASSERT_TRUE(words.draw(kFrame, mediaTime(2)));
  EXPECT_TRUE(words.draw(kFrame, mediaTime(2), {.none = true}));
  EXPECT_TRUE(words.pictures().empty());
  EXPECT_TRUE(words.draw(kFrame, mediaTime(2)));
  EXPECT_FALSE(words.pictures().empty());
}

// ffmpeg reads what was written.
TEST(PngFile, OtherProgramsReadItToTheBit) {
  const test::TemporaryFolder folder;
  constexpr int kWidth = 301, kHeight = 97;  // more than one block of 65535 bytes
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 3 * kWidth * kHeight; ++i) rgb.push_back(static_cast<std::uint8_t>(i * 7 + i / 256));
  ASSERT_TRUE(writePng(folder / "a.png", kWidth, kHeight, rgb));
  EXPECT_FALSE(writePng(folder / "a.png", kWidth, kHeight, rgb)) << "it replaces none";
  const std::string command =
      "ffmpeg -v error -i " + (folder / "a.png") + " -f rawvideo -pix_fmt rgb24 " + (folder / "raw");
  if (std::system(command.c_str()) != 0)
    GTEST_SKIP() << "no ffmpeg program here";  // NOLINT(bugprone-command-processor)
  std::ifstream raw(folder / "raw", std::ios::binary);
  const std::vector<std::uint8_t> read((std::istreambuf_iterator<char>(raw)), {});
  EXPECT_EQ(read, rgb);
}

}  // namespace
}  // namespace relievo
