// SPDX-License-Identifier: Apache-2.0
// Text over the picture: its position for each eye and in depth, and that it is legible ink.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "app/render/text/ass_text.h"
#include "tests/golden/picture_stage.h"

namespace relievo::test {
namespace {

constexpr DisplayVolume kVolume{160.0, 90.0, 40.0};
constexpr const char* kHead = "[Script Info]\nPlayResX: 1280\nPlayResY: 720\nWrapStyle: 2\n";

Scene blackScene(const StereoSettings& stereo) {
  return {.color = makeRgbFrame(32, 18, [](int, int) { return Rgb{0, 0, 0}; }), .volume = kVolume, .stereo = stereo};
}

// White words at the foot, a little left of the middle.
std::vector<TextPicture> words(AssText& text, const TextFrame& frame, const std::string& said = "what is going on") {
  text.begin(kHead);
  text.add("0,0,Default,,0,0,0,,{\\an1\\pos(400,690)\\fs40\\bord0\\shad0}" + said, Duration(0),
           std::chrono::seconds(9));
  std::vector<TextPicture> pictures;
  text.draw(frame, Duration(0), pictures);
  return pictures;
}

#define TEXT_OR_SKIP(text)                                       \
  auto text##_made = AssText::create();                          \
  if (!text##_made) GTEST_SKIP() << text##_made.error().message; \
  AssText& text = *text##_made

TEST(RenderText, IsAtTheSamePlaceForBothEyes) {
  STAGE_OR_SKIP(stage, 1280, 720);
  TEXT_OR_SKIP(text);
  const TextFrame half{.width = 640, .height = 720, .aspect = 16.0 / 9};
  stage.renderer().setText(half, words(text, half));
  for (const double screen_z : {20.0, 5.0}) {
    const Image image =
        stage.show(blackScene({.layout = StereoLayout::SideBySide, .strength = 2, .screen_z_mm = screen_z}));
    const Spot left = image.centroid(1, 0, 640), right = image.centroid(1, 640, 1280);
    EXPECT_GT(left.weight, 100);
    EXPECT_NEAR(left.x, right.x - 640, 1e-6);
    EXPECT_NEAR(left.y, right.y, 1e-6);
  }
}

// A view of half the width shows the words half as wide: the viewer's screen stretches them again.
TEST(RenderText, KeepsItsShapeForTheViewer) {
  TEXT_OR_SKIP(text);
  const auto whole = words(text, {.width = 1280, .height = 720, .aspect = 16.0 / 9});
  const auto squeezed = words(text, {.width = 640, .height = 720, .aspect = 16.0 / 9});
  ASSERT_EQ(whole.size(), 1u);
  ASSERT_EQ(squeezed.size(), 1u);
  EXPECT_NEAR(squeezed[0].width, 0.5 * whole[0].width, 0.04 * whole[0].width) << "letters keep to whole pixels";
  EXPECT_NEAR(squeezed[0].height, whole[0].height, 2);
  EXPECT_NEAR(squeezed[0].x, 0.5 * whole[0].x, 2);
}

TEST(RenderText, GoesWithoutATrace) {
  STAGE_OR_SKIP(stage, 640, 360);
  TEXT_OR_SKIP(text);
  const Scene scene = blackScene({.layout = StereoLayout::Mono});
  const TextFrame frame{.width = 640, .height = 360};
  stage.renderer().setText(frame, words(text, frame));
  EXPECT_GT(stage.show(scene).centroid(0, 0, 640).weight, 10);
  stage.renderer().setText(frame, {});
  EXPECT_EQ(stage.show(scene).centroid(0, 0, 640).weight, 0);
}

// The picture on the screen is libass's, to the bit of an opaque pixel.
TEST(RenderText, ShowsWhatLibassDraws) {
  STAGE_OR_SKIP(stage, 640, 360);
  TEXT_OR_SKIP(text);
  const TextFrame frame{.width = 640, .height = 360};
  const auto pictures = words(text, frame);
  ASSERT_EQ(pictures.size(), 1u);
  stage.renderer().setText(frame, pictures);
  const Image image = stage.show(blackScene({.layout = StereoLayout::Mono}));
  const TextPicture& picture = pictures[0];
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const int ink = picture.rgba[4 * (static_cast<std::size_t>(y) * picture.width + x)];
      ASSERT_NEAR(image.channel(picture.x + x, picture.y + y, 0), ink, 1) << x << " " << y;
    }
  }
}

// A wall 35 mm high: 15 mm in front of the screen plane, which is 8 * 63 * 15 / 585 px / 2 in a squeezed half.
TEST(RenderText, SubtitlesStandInFrontOfTheReliefBehindThem) {
  STAGE_OR_SKIP(stage, 1280, 720);
  TEXT_OR_SKIP(text);
  const TextFrame half{.width = 640, .height = 720, .aspect = 16.0 / 9};
  stage.renderer().setSubtitles(half, words(text, half));
  Scene scene = blackScene({.layout = StereoLayout::SideBySide, .screen_z_mm = 20});
  scene.calibration.bits = 16;
  scene.depth = makePlane(64, 36, 16, 65535 * 35 / 40);
  const Image image = stage.show(scene);
  const Spot left = image.centroid(1, 0, 640), right = image.centroid(1, 640, 1280);
  const double wall_px = 4 * 63.0 * 15 / 585, in_front_px = 0.002 * 640;
  EXPECT_NEAR(left.x - (right.x - 640), wall_px + in_front_px, 0.1);
  EXPECT_NEAR(stage.renderer().statistics().behind_words_px, wall_px, 0.05);
  EXPECT_NEAR(left.y, right.y, 0.05);
}

int inkOf(const std::vector<TextPicture>& pictures) {
  int ink = 0;
  for (const TextPicture& picture : pictures) {
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) ink += picture.rgba[i] > 128;
  }
  return ink;
}

TEST(AssText, LettersAreLetters) {
  TEXT_OR_SKIP(text);
  const TextFrame frame{.width = 1280, .height = 720};
  const int one = inkOf(words(text, frame, "l")), wide = inkOf(words(text, frame, "M"));
  EXPECT_GT(one, 20);
  EXPECT_GT(wide, one);
  EXPECT_EQ(inkOf(words(text, frame, " ")), 0);
  EXPECT_GT(inkOf(words(text, frame, AssText::escaped("{l}"))), one) << "braces are letters too";
}

// Joined letters take less room than those letters apart: the font shapes them.
TEST(AssText, ArabicIsJoined) {
  TEXT_OR_SKIP(text);
  const TextFrame frame{.width = 1280, .height = 720};
  const auto joined = words(text, frame, "\u0628\u0628\u0628"),
             apart = words(text, frame, "\u0628\u200c\u0628\u200c\u0628");
  ASSERT_EQ(joined.size(), 1u);
  ASSERT_FALSE(apart.empty());
  int apart_width = 0;
  for (const TextPicture& picture : apart) apart_width = std::max(apart_width, picture.x + picture.width - apart[0].x);
  EXPECT_LT(joined[0].width, apart_width);
}

TEST(AssText, SaysOnceThatNoFontHasALetter) {
  auto text = AssText::create();
  if (!text) GTEST_SKIP() << "no font here";
  text->begin("[Script Info]\nPlayResX: 640\nPlayResY: 360\n");
  std::vector<TextPicture> pictures;
  std::vector<char32_t> missing;
  for (const char* const words : {"A\xe2\x81\xa0", "\xf4\x8f\xbf\xb4", "\xf4\x8f\xbf\xb5"}) {  // a joiner; no letters
    text->removeLines();
    text->add(std::string("0,0,Default,,0,0,0,,") + words, Duration(0), std::chrono::seconds(1));
    text->draw({.width = 640, .height = 360}, Duration(0), pictures, true);
    missing.push_back(text->takeMissingLetter());
  }
  EXPECT_EQ(missing, (std::vector<char32_t>{0, 0x10fff4, 0}));
}

TEST(AssText, SaysWhetherItHasChanged) {
  TEXT_OR_SKIP(text);
  text.begin(kHead);
  text.add("0,0,Default,,0,0,0,,one", Duration(0), std::chrono::seconds(1));
  std::vector<TextPicture> pictures;
  const TextFrame frame{.width = 640, .height = 360};
  EXPECT_TRUE(text.draw(frame, Duration(0), pictures));
  EXPECT_FALSE(text.draw(frame, std::chrono::milliseconds(500), pictures));
  EXPECT_FALSE(pictures.empty());
  EXPECT_TRUE(text.draw(frame, std::chrono::seconds(2), pictures));
  EXPECT_TRUE(pictures.empty());
}

// Whether there is ink in the upper left corner.
bool isInTheCorner(const std::vector<TextPicture>& pictures) {
  return std::ranges::any_of(pictures, [](const TextPicture& each) { return each.x < 100 && each.y < 100; });
}
constexpr const char* kCorner = "0,0,Default,,0,0,0,,{\\an7\\pos(10,10)\\fs20}seen";

TEST(AssText, UpTo1000LinesAreAllSeen) {
  auto made = AssText::create(true);
  if (!made) GTEST_SKIP() << made.error().message;
  AssText& text = *made;
  text.begin(kHead);
  for (int i = 0; i < 300; ++i)
    text.add("0,0,Default,,0,0,0,,{\\pos(900,500)\\fs20}a", Duration(0), std::chrono::seconds(9));
  text.add(kCorner, Duration(0), std::chrono::seconds(9));
  std::vector<TextPicture> pictures;
  ASSERT_TRUE(text.draw({.width = 1280, .height = 720, .aspect = 16.0 / 9}, Duration(0), pictures));
  EXPECT_TRUE(isInTheCorner(pictures));
  text.begin(kHead);
  for (int i = 0; i < 1000; ++i)
    text.add("0,0,Default,,0,0,0,,{\\pos(900,500)\\fs20}a", Duration(0), std::chrono::seconds(9));
  text.add(kCorner, Duration(0), std::chrono::seconds(9));
  text.draw({.width = 1280, .height = 720, .aspect = 16.0 / 9}, Duration(0), pictures);
  EXPECT_FALSE(isInTheCorner(pictures)) << "more than 1000";
}

// Each is a drawing of 3000 curves across one another, which takes libass some tenths of a second.
TEST(AssText, LinesThatTakeTooLongAreLeftOut) {
  auto made = AssText::create(true);
  if (!made) GTEST_SKIP() << made.error().message;
  AssText& text = *made;
  text.begin(kHead);
  std::minstd_rand random(1);
  const auto place = [&] { return " " + std::to_string(random() % 500); };
  std::string curves = "m 0 0";
  for (int i = 0; i < 3000; ++i) curves += " b" + place() + place() + place() + place() + place() + place();
  for (int i = 0; i < 200; ++i)
    text.add("0,0,Default,,0,0,0,,{\\p1\\an7\\pos(600,150)\\frz" + std::to_string(0.1 * i) + "}" + curves, Duration(0),
             std::chrono::seconds(9));
  text.add(kCorner, Duration(0), std::chrono::seconds(9));
  std::vector<TextPicture> pictures;
  text.draw({.width = 1280, .height = 720, .aspect = 16.0 / 9}, Duration(0), pictures);
  EXPECT_FALSE(isInTheCorner(pictures));
  text.begin(kHead);
  text.add(kCorner, Duration(0), std::chrono::seconds(9));
  text.add("0,0,Default,,0,0,0,,{\\pos(900,500)}" + std::string(200000, 'x'), Duration(0), std::chrono::seconds(9));
  text.draw({.width = 1280, .height = 720, .aspect = 16.0 / 9}, Duration(0), pictures);
  ASSERT_EQ(pictures.size(), 1U) << "a line of 200 kB is left out";
  EXPECT_TRUE(isInTheCorner(pictures)) << "another script";
}

// Five such letters took libass 7 s and 1.4 GB.
TEST(AssText, LinesOfHugeLettersAreLeftOutWhichIsSaidOnce) {
  auto made = AssText::create(true);
  if (!made) GTEST_SKIP() << made.error().message;
  AssText& text = *made;
  text.begin(kHead);
  testing::internal::CaptureStderr();
  for (int i = 0; i < 3; ++i)
    text.add("0,0,Default,,0,0,0,,{\\pos(9000,500)\\fs12000}Hello", Duration(0), std::chrono::seconds(9));
  text.add(kCorner, Duration(0), std::chrono::seconds(9));
  std::vector<TextPicture> pictures;
  text.draw({.width = 1280, .height = 720, .aspect = 16.0 / 9}, Duration(0), pictures);
  const std::string told = testing::internal::GetCapturedStderr();
  ASSERT_EQ(pictures.size(), 1U);
  EXPECT_TRUE(isInTheCorner(pictures));
  EXPECT_NE(told.find("larger than the screen"), std::string::npos) << told;
  EXPECT_EQ(std::ranges::count(told, '\n'), 1) << told;
}

// Squares 2788 high in a script of 720 rows: each covers 15 of the screen's.
TEST(AssText, LinesThatTogetherCoverTheScreenOver128TimesAreLeftOut) {
  auto made = AssText::create(true);
  if (!made) GTEST_SKIP() << made.error().message;
  AssText& text = *made;
  for (const int lines : {8, 9}) {
    text.begin(kHead);
    for (int i = 0; i < lines; ++i)
      text.add("0,0,Default,,0,0,0,,{\\an7\\pos(900,500)\\p1}m 0 0 l 2788 0 2788 2788 0 2788", Duration(0),
               std::chrono::seconds(9));
    text.add(kCorner, Duration(0), std::chrono::seconds(9));
    std::vector<TextPicture> pictures;
    testing::internal::CaptureStderr();
    text.draw({.width = 1280, .height = 720, .aspect = 16.0 / 9}, Duration(0), pictures);
    const std::string told = testing::internal::GetCapturedStderr();
    EXPECT_EQ(isInTheCorner(pictures), lines == 8) << lines;
    EXPECT_EQ(told.find("larger than the screen") != std::string::npos, lines == 9) << told;
  }
}

// Lines in a head are no part of it, and would not be measured.
TEST(AssText, AHeadShowsNothing) {
  auto made = AssText::create(true);
  if (!made) GTEST_SKIP() << made.error().message;
  made->begin(std::string(kHead) +
              "[Events]\nFormat: Layer, Start, End, Style, Name, MarginL, MarginR, MarginV, Effect, "
              "Text\nDialogue: 0,0:00:00.00,0:00:09.00,Default,,0,0,0,,seen\n");
  std::vector<TextPicture> pictures;
  made->draw({.width = 1280, .height = 720, .aspect = 16.0 / 9}, Duration(0), pictures);
  EXPECT_TRUE(pictures.empty());
}

}  // namespace
}  // namespace relievo::test
