// SPDX-License-Identifier: Apache-2.0
// Where the rows of the list and their posters are, and which film a mouse is over.
#include "app/player/screen/list_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/player/screen/screen_script.h"

namespace relievo {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

constexpr double kAspect = 16.0 / 9;

ScreenList list() {
  ScreenList list;
  list.films = 2;
  list.number = list.of = 2;
  list.selected = 1;
  list.rows = {{.title = "Videos", .top = 80},
               {.title = "one", .detail = "0:30 of 2:00", .film = 0, .top = 126, .left = 0.25},
               {.title = "{\\fs9}", .film = 1, .top = 222}};
  return list;
}

TEST(ListScript, TellsTheFilmUnderAMouse) {
  const auto at = [](double x, double y) { return listFilmAt(list(), x / 1280, y / 720, kAspect); };
  EXPECT_EQ(at(600, 127), 0u);
  EXPECT_EQ(at(600, 221), 0u);
  EXPECT_EQ(at(600, 223), 1u);
  EXPECT_EQ(at(600, 317), 1u);
  EXPECT_FALSE(at(600, 319)) << "below the last row";
  EXPECT_FALSE(at(600, 100)) << "a heading";
  EXPECT_FALSE(at(10, 200)) << "beside the rows";
}

// "h: all keys" has 11 letters of 11.44 and ends at 1240.
TEST(ListScript, TellsTheMouseOverTheWordsAboutTheKeys) {
  const auto at = [](double x, double y) { return isListHelpAt("h", x / 1280, y / 720, kAspect); };
  EXPECT_TRUE(at(1120, 690));
  EXPECT_TRUE(at(1239, 719));
  EXPECT_FALSE(at(1100, 690));
  EXPECT_FALSE(at(1250, 690));
  EXPECT_FALSE(at(1200, 670));
  EXPECT_FALSE(isListHelpAt("", 1200 / 1280.0, 690 / 720.0, kAspect)) << "no key shows them";
}

TEST(ListScript, ItsFootNamesTheKeyOfTheViewersHands) {
  ScreenContent content;
  content.list = list();
  content.help_key = "Pad Start";
  content.choose_key = "Pad A or Cross";
  EXPECT_THAT(screenLines(content, kAspect), Contains(HasSubstr("}Up and down choose, Pad A or Cross plays")));
  EXPECT_THAT(screenLines(content, 1), Not(Contains(HasSubstr("choose"))));
  EXPECT_THAT(screenLines(content, 1), Contains(HasSubstr("}Pad Start: all keys")));
}

TEST(ListScript, SaysItsTitlesAsTheyAre) {
  ScreenContent content;
  content.list = list();
  const auto lines = screenLines(content, kAspect);
  EXPECT_THAT(lines, Contains(HasSubstr("}one")));
  EXPECT_THAT(lines, Contains(HasSubstr("}0:30 of 2:00")));
  EXPECT_THAT(lines, Contains(HasSubstr("}\\{\\\u2060fs9}")));
  EXPECT_THAT(lines, Contains(HasSubstr("}2 of 2")));
}

// Over the posters, and beside the heading.
TEST(ListScript, NoticesAndWarningsLieOverThePosters) {
  ScreenContent content;
  content.list = list();
  const auto under = screenLines(content, kAspect);
  EXPECT_THAT(linesOverPosters(content, kAspect), SizeIs(0));
  content.notice = ScreenNotice{"Volume 80 %", 0.6};
  content.warning = "a.mkv: damaged";
  EXPECT_EQ(screenLines(content, kAspect), under);
  const auto over = linesOverPosters(content, kAspect);
  EXPECT_THAT(over, Contains(HasSubstr("}Volume 80 %")));
  EXPECT_THAT(over, Contains(HasSubstr("}a.mkv: damaged")));
}

TEST(ListScript, WithoutFilmsItSaysOneSentence) {
  ScreenContent content;
  content.help_key = "Help or Menu";
  content.list = ScreenList{.rows = {}, .message = "No films yet", .pointed = {}};
  const auto lines = screenLines(content, kAspect);
  EXPECT_THAT(lines, Contains(HasSubstr("}No films yet")));
  EXPECT_THAT(lines, Not(Contains(HasSubstr("OK plays"))));
  EXPECT_THAT(lines, Contains(HasSubstr("}Help or Menu: all keys")));
}

// The view of one eye side by side has half the pixels across: the poster has, too.
TEST(ListScript, APosterKeepsItsShapeInEveryLayout) {
  ScreenList one = list();
  TextPicture picture{0, 0, 96, 108, 96, 108, std::vector<std::uint8_t>(4 * 96 * 108)};
  one.rows[1].picture = std::make_shared<const TextPicture>(picture);
  const auto mono = postersOf(one, {.width = 1280, .height = 720, .aspect = kAspect});
  const auto half = postersOf(one, {.width = 640, .height = 720, .aspect = kAspect});
  ASSERT_THAT(mono, SizeIs(1));
  ASSERT_THAT(half, SizeIs(1));
  EXPECT_EQ(mono[0].height, 83);
  EXPECT_EQ(mono[0].width, 74) << "83 * 96 / 108";
  EXPECT_EQ(half[0].height, 83);
  EXPECT_EQ(half[0].width, 37);
  EXPECT_NEAR(half[0].x, 0.5 * mono[0].x, 1);
  EXPECT_EQ(mono[0].y, 131);
  EXPECT_EQ(half[0].y, 131);
  EXPECT_EQ(mono[0].cols, 96);
}

}  // namespace
}  // namespace relievo
