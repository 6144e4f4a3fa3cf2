// SPDX-License-Identifier: Apache-2.0
// Long texts are broken into lines that fit, and the bar is where it should be.
#include "app/player/screen/screen_script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/player/control/key_table.h"
#include "app/player/screen/bar_script.h"
#include "app/player/screen/fold.h"
#include "app/player/screen/keys_script.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

TEST(Fold, KeepsShortTextAndBreaksLongTextAtSpaces) {
  EXPECT_THAT(folded("a short name", 40, 2), ElementsAre("a short name"));
  EXPECT_THAT(folded("one two three four five", 12, 3), ElementsAre("one two ", "three four ", "five"));
  EXPECT_THAT(folded("", 40, 2), SizeIs(0));
}

TEST(Fold, ShowsBeginningAndEndOfAFileNameThatIsTooLong) {
  const std::string name = "begin_" + std::string(200, 'x') + "_end.mkv";
  const auto lines = folded(name, 40, 2);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_TRUE(lines[0].starts_with("begin_"));
  EXPECT_TRUE(lines[1].ends_with("_end.mkv"));
  EXPECT_THAT(lines[1], HasSubstr("…"));
  EXPECT_LE(lines[1].size(), 42u) << "40 cells, one of them of three bytes";
}

TEST(Fold, WideLettersTakeTwoCells) {
  EXPECT_THAT(folded("日本語の映画", 6, 2), ElementsAre("日本語", "の映画"));
  EXPECT_THAT(folded("فيلم", 4, 1), ElementsAre("فيلم"));
}

TEST(Fold, ANumberIsNotBroken) {
  EXPECT_THAT(folded("steps of 4.54 mm", 11, 2), ElementsAre("steps of ", "4.54 mm"));
  EXPECT_THAT(folded("read from .npy", 11, 2), ElementsAre("read from ", ".npy"));
  EXPECT_THAT(folded("one.film.mkv", 9, 2), ElementsAre("one.film.", "mkv"));
}

TEST(Fold, BrokenBytesAreNeitherLostNorReadPast) {
  for (const char* broken : {"\xff", "\xc3", "a\xe2\x82", "\xf0\x9f"}) {
    EXPECT_THAT(folded(broken, 10, 1), ElementsAre(broken));
  }
}

TEST(ScreenScript, WordsHaveNoMeaningOfTheirOwn) {
  ScreenContent content;
  content.hint = "{\\fs200}\\N";
  const auto lines = screenLines(content, 16.0 / 9);
  ASSERT_THAT(lines, SizeIs(1));
  EXPECT_THAT(lines[0], HasSubstr("}\\{\\\u2060fs200}"));
}

TEST(ScreenScript, TheTimesStayWholeInANarrowWindow) {
  ScreenContent content;
  content.bar = ScreenBar{.times = "1:01:07 / 1:02:12   paused   1/8x   film 12 of 345   repeat"};
  const auto isShown = [&](double aspect, const std::string& words) {
    return testing::Value(screenLines(content, aspect), testing::Contains(testing::EndsWith(words)));
  };
  EXPECT_TRUE(isShown(16.0 / 9, "}1:01:07 / 1:02:12   paused   1/8x   film 12 of 345   repeat"));
  EXPECT_TRUE(isShown(0.4, "}1:01:07 / 1:02:12   paused   1/8x   film 12 of 345")) << "51 letters";
}

// The status stands above the bar where there is no room beside the times.
TEST(ScreenScript, TheStatusIsWholeInAPortraitWindow) {
  ScreenContent content;
  content.bar = ScreenBar{
      .title = "film.mkv", .times = "0:07 / 0:12   paused   film 12 of 345", .status = "3D: mono   touch: mouse"};
  for (const double aspect : {16.0 / 9, 9.0 / 16}) {
    const auto lines = screenLines(content, aspect);
    EXPECT_THAT(lines, testing::Contains(testing::EndsWith("}3D: mono   touch: mouse"))) << aspect;
    EXPECT_THAT(lines, testing::Contains(testing::EndsWith("}0:07 / 0:12   paused   film 12 of 345"))) << aspect;
  }
  const double wide = roomForWords(content, 16.0 / 9), portrait = roomForWords(content, 9.0 / 16);
  content.bar->status.clear();
  EXPECT_EQ(roomForWords(content, 16.0 / 9), wide);
  EXPECT_GT(roomForWords(content, 9.0 / 16), portrait);
}

// The view of 405 x 720 is laid out as one of 720 x 1280.
TEST(ScreenScript, APortraitViewHasRoomForALineOfFigures) {
  ScreenContent content;
  content.statistics = {{"rate", "29.9 of 30.00 frames/s, 0 dropped"}};
  EXPECT_THAT(screenLines(content, 9.0 / 16), testing::Contains(testing::EndsWith("frames/s, 0 dropped")));
  constexpr double kBarFromBottom = 720 - 664;
  EXPECT_NEAR(barShareAt(40.0 / 720, 1 - kBarFromBottom / 1280, 9.0 / 16).value_or(-1), 0, 1e-9);
  EXPECT_NEAR(barShareAt(1 - 40.0 / 720, 1 - kBarFromBottom / 1280, 9.0 / 16).value_or(-1), 1, 1e-9);
  EXPECT_FALSE(barShareAt(0.5, 1 - kBarFromBottom / 720, 9.0 / 16)) << "above it";
}

// In the window of a portrait film on a screen of 640x360.
TEST(ScreenScript, LongKeysStayWholeInANarrowWindow) {
  constexpr double kAspect = 9.0 / 16;
  constexpr int kHeight = 331;
  ScreenContent content;
  content.keys = KeyTable::usual().rowsIn(PlayerState::Playing, KeyBoard::Keyboard);
  std::vector<std::string> lines;
  for (; content.keys_page < keyPages(content.keys, kAspect, kHeight); ++content.keys_page) {
    for (std::string& line : screenLines(content, kAspect, kHeight)) lines.push_back(std::move(line));
  }
  EXPECT_THAT(lines, testing::Contains(testing::EndsWith("}Backspace")));
  EXPECT_THAT(lines, testing::Contains(HasSubstr("(comma)")));
}

// Else a second click would meet another word.
TEST(ScreenScript, NoButtonMovesWhenItsWordChanges) {
  using enum PlayerVerb;
  const auto leftEnd = [](const ScreenBar& bar, PlayerVerb verb) {
    int x = 0;
    while (x < 1280 && barButtonAt(bar, x / 1280.0, 597.0 / 720, 16.0 / 9) != verb) ++x;
    return x;
  };
  const ScreenBar before{.title = "film", .buttons = {{PlayPause, "Pause"}, {FullScreen, "Full screen"}}};
  const ScreenBar after{.title = "film", .buttons = {{PlayPause, "Play"}, {FullScreen, "Window"}}};
  EXPECT_LT(leftEnd(before, PlayPause), leftEnd(before, FullScreen));
  EXPECT_EQ(leftEnd(before, PlayPause), leftEnd(after, PlayPause));
  EXPECT_EQ(leftEnd(before, FullScreen), leftEnd(after, FullScreen));
}

TEST(ScreenScript, ButtonsLeaveTheTitleWhole) {
  ScreenContent content;
  content.bar = ScreenBar{.title = std::string(70, 'x'), .buttons = {{PlayerVerb::FullScreen, "Full screen"}}};
  EXPECT_THAT(screenLines(content, 16.0 / 9), testing::Contains(testing::EndsWith("}" + content.bar->title)));
}

TEST(ScreenScript, TheBarIsWhereItIsDrawn) {
  constexpr double kAspect = 16.0 / 9, kDown = 664.0 / 720;
  EXPECT_NEAR(*barShareAt(0.5, kDown, kAspect), 0.5, 1e-9);
  EXPECT_NEAR(*barShareAt(40.0 / 1280, kDown, kAspect), 0, 1e-9);
  EXPECT_NEAR(*barShareAt(1240.0 / 1280, kDown, kAspect), 1, 1e-9);
  EXPECT_NEAR(*barShareAt(1250.0 / 1280, kDown, kAspect), 1, 1e-9) << "a little beside its end";
  EXPECT_FALSE(barShareAt(0.5, 0.5, kAspect));
}

}  // namespace
}  // namespace relievo
