// SPDX-License-Identifier: Apache-2.0
// What the screen says, and when it falls silent.
#include "app/player/screen/screen_text.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/player/screen/notices.h"
#include "app/player/screen/statistics.h"

namespace relievo {
namespace {

using std::chrono::seconds;

const MonotonicTime kStart{std::chrono::hours(1)};

ScreenFacts playing() {
  return {.title = "film.mkv",
          .position_s = 83.9,
          .duration_s = 3725,
          .state = PlayerState::Playing,
          .stereo = {.layout = StereoLayout::TopBottom},
          .has_depth = true,
          .fingers = {{{.haptic = "Novint Falcon", .contact = true}}}};
}

const ScreenRows kNone;

ScreenContent at(const ScreenText& text, const ScreenFacts& facts, MonotonicTime now = kStart) {
  return text.content(facts, kNone, now);
}

TEST(ScreenText, TellsTitleTimeStereoAndTouch) {
  ScreenText text;
  text.wake(kStart);
  const auto bar = at(text, playing()).bar;
  ASSERT_TRUE(bar);
  EXPECT_EQ(bar->title, "film.mkv");
  EXPECT_EQ(bar->times, "1:23 / 1:02:05");
  EXPECT_EQ(bar->status, "3D: top and bottom   touch: Novint Falcon, in contact");
  EXPECT_NEAR(bar->position, 83.9 / 3725, 1e-3);
}

TEST(ScreenText, DoesNotSpeakOfTheDepthOfAFilmThatIsBeingOpened) {
  ScreenText text;
  text.wake(kStart);
  const auto bar = at(text, {.title = "film.mkv", .state = PlayerState::Opening, .held = true}).bar;
  EXPECT_EQ(bar->status, "");
  EXPECT_EQ(bar->times, "0:00   opening   paused");
}

TEST(ScreenText, TellsBothFingers) {
  ScreenText text;
  text.wake(kStart);
  ScreenFacts facts = playing();
  facts.fingers[1] = {.haptic = "Xbox pad", .force_n = 0.5, .across = 0.6, .up = 0};
  const ScreenContent content = at(text, facts);
  EXPECT_EQ(content.bar->status, "3D: top and bottom   touch: Novint Falcon, in contact and Xbox pad");
  EXPECT_TRUE(content.forces_n[0]);
  EXPECT_EQ(content.forces_n[1], 0.5);
  EXPECT_FALSE(content.fingers[0]);
  EXPECT_EQ(content.fingers[1], (FingerBeside{0.6, 0}));
  facts.has_depth = false;
  EXPECT_EQ(at(text, facts).bar->status.substr(3), " top and bottom   no depth in this film, nothing to feel");
}

TEST(ScreenText, TellsSpeedAndPlaceInTheList) {
  ScreenText text;
  text.wake(kStart);
  ScreenFacts facts = playing();
  facts.rate = 4;
  facts.film = 2;
  facts.films = 5;
  EXPECT_EQ(at(text, facts).bar->times, "1:23 / 1:02:05   4x   film 2 of 5");
  facts = playing();
  facts.rate = 0.125;
  facts.loop = true;
  EXPECT_EQ(at(text, facts).bar->times, "1:23 / 1:02:05   1/8x   repeat");
  facts = playing();
  facts.position_s = facts.duration_s + 0.9;
  EXPECT_EQ(at(text, facts).bar->times, "1:02:05 / 1:02:05") << "the last picture of a loop";
}

TEST(ScreenText, FallsSilentFourSecondsAfterTheLastKey) {
  ScreenText text;
  EXPECT_TRUE(at(text, playing()).empty());
  text.wake(kStart);
  EXPECT_FALSE(at(text, playing(), kStart + seconds(3)).empty());
  EXPECT_TRUE(at(text, playing(), kStart + seconds(4)).empty());
}

TEST(ScreenText, StaysWhileTheFilmIsHeldAndOnWish) {
  ScreenText text;
  ScreenFacts facts = playing();
  facts.held = true;
  ASSERT_TRUE(at(text, facts).bar);
  EXPECT_EQ(at(text, facts).bar->times, "1:23 / 1:02:05   paused");
  text.toggleBar();
  EXPECT_TRUE(at(text, playing()).bar);
  text.toggleBar();
  EXPECT_FALSE(at(text, playing()).bar);
}

TEST(ScreenText, TellsOnceWhatWentWrong) {
  ScreenText text;
  text.tell("device lost", kStart);
  EXPECT_EQ(at(text, playing(), kStart + seconds(7)).warning, "device lost");
  EXPECT_TRUE(at(text, playing(), kStart + seconds(8)).empty());
  text.wake(kStart + seconds(9));
  EXPECT_EQ(at(text, playing(), kStart + seconds(9)).warning, "");
}

TEST(ScreenText, TellsWhyThereIsNothingToSeeOrFeel) {
  ScreenText text;
  text.wake(kStart);
  ScreenFacts facts = playing();
  facts.state = PlayerState::Buffering;
  facts.duration_s = 0;
  facts.has_depth = false;
  facts.stereo = {.layout = StereoLayout::Mono};
  const auto bar = at(text, facts).bar;
  EXPECT_EQ(bar->times, "1:23   buffering");
  EXPECT_EQ(bar->status, "3D: off   no depth in this film, nothing to feel");
  EXPECT_FALSE(bar->has_length);
  EXPECT_FALSE(at(text, facts).forces_n[0]) << "nothing is felt";
  facts.fingers[0].haptic.clear();
  facts.has_depth = true;
  facts.stereo.swap_eyes = true;
  facts.stereo.strength = 0.7;
  EXPECT_EQ(at(text, facts).bar->status, "3D: off, eyes swapped, depth 70 %   touch: no device");
}

TEST(ScreenText, ANoticeAndTheHintStandForTwoSeconds) {
  ScreenText text;
  text.notice({"Volume 80 %", 0.6}, kStart);
  text.hint("press", kStart);
  EXPECT_EQ(at(text, playing(), kStart + seconds(1)).notice->words, "Volume 80 %");
  EXPECT_EQ(at(text, playing(), kStart + seconds(1)).hint, "press");
  EXPECT_EQ(text.noticed(kStart + seconds(1)), "Volume 80 %") << "for the terminal";
  EXPECT_EQ(text.noticed(kStart + seconds(2)), "");
  EXPECT_FALSE(at(text, playing(), kStart + seconds(1)).bar) << "a value needs no bar";
  EXPECT_TRUE(at(text, playing(), kStart + seconds(2)).empty());
}

TEST(ScreenText, ForceChaptersAndBufferAreSharesOfWhatIsShown) {
  ScreenText text;
  text.wake(kStart);
  text.setChapters({0, 931.25});
  ScreenFacts facts = playing();
  facts.fingers[0].force_n = 1.234;
  facts.buffered_s = 186.25;
  const ScreenContent content = at(text, facts);
  EXPECT_NEAR(*content.forces_n[0], 1.25, 1e-9);
  EXPECT_NEAR(content.bar->buffered, 0.05, 1e-9);
  EXPECT_EQ(content.bar->chapters, (std::vector<double>{0, 0.25}));
}

TEST(ScreenText, TellsTheTimeUnderTheMouseWhileItIsOverTheBar) {
  ScreenText text;
  text.wake(kStart);
  text.point(0.5, std::nullopt, kStart);
  const auto bar = at(text, playing()).bar;
  ASSERT_TRUE(bar);
  EXPECT_EQ(bar->pointed, 0.5);
  EXPECT_EQ(bar->pointed_time, "31:02") << "3725 s by 2";
  text.point(std::nullopt, std::nullopt, kStart);
  EXPECT_FALSE(at(text, playing()).bar->pointed);
}

// The words say what a click does now.
TEST(ScreenText, AButtonsWordFollowsTheStateAndTheMouseMarksIt) {
  ScreenText text;
  text.wake(kStart);
  ScreenFacts facts = playing();
  EXPECT_TRUE(at(text, facts).bar->buttons.empty()) << "without a mouse";
  facts.buttons = {PlayerVerb::PlayPause, PlayerVerb::FullScreen};
  EXPECT_EQ(at(text, facts).bar->buttons[0].word, "Pause");
  EXPECT_EQ(at(text, facts).bar->buttons[1].word, "Full screen");
  EXPECT_EQ(at(text, facts).bar->pointed_button, std::nullopt);
  facts.held = facts.full_screen = true;
  text.point(std::nullopt, PlayerVerb::FullScreen, kStart);
  EXPECT_EQ(at(text, facts).bar->buttons[0].word, "Play");
  EXPECT_EQ(at(text, facts).bar->buttons[1].word, "Window");
  EXPECT_EQ(at(text, facts).bar->pointed_button, PlayerVerb::FullScreen);
}

TEST(ScreenText, MarksAFingerBesideThePictureAlone) {
  const ScreenText text;
  ScreenFacts facts = playing();
  facts.fingers[0].across = 0.49, facts.fingers[0].up = -0.5;
  EXPECT_FALSE(at(text, facts).fingers[0]);
  facts.fingers[0].across = 0.6;
  EXPECT_EQ(at(text, facts).fingers[0], (FingerBeside{0.6, -0.5}));
}

TEST(ScreenText, KeysAndStatisticsComeAndGo) {
  ScreenText text;
  text.turnKeys({{"SPACE", "pause"}}, 1);
  text.toggleStatistics();
  EXPECT_EQ(text.content(playing(), {{"tick", "1 kHz"}}, kStart).statistics.size(), 0u) << "the keys stand alone";
  EXPECT_EQ(at(text, playing()).keys.front().first, "SPACE");
  text.turnKeys({{"SPACE", "pause"}}, 1);
  EXPECT_EQ(text.content(playing(), {{"tick", "1 kHz"}}, kStart).statistics.front().second, "1 kHz");
  text.toggleStatistics();
  EXPECT_TRUE(text.content(playing(), {{"tick", "1 kHz"}}, kStart).empty());
}

TEST(ScreenText, AKeyToAChapterTellsWhichItIs) {
  ScreenFacts facts = playing();
  const PlayerCommand command{PlayerVerb::ChapterBy, 1};
  facts.chapter = "2 of 4, The Nose";
  EXPECT_EQ(noticeOf(command, facts)->words, "Chapter 2 of 4, The Nose");
}

TEST(ScreenText, TheUsualSpeedIsToldInPlaceOfTheOneBefore) {
  const auto notice = noticeOf({PlayerVerb::NormalSpeed}, playing());
  ASSERT_TRUE(notice);
  EXPECT_EQ(notice->words, "Speed 1x");
}

TEST(ScreenText, KeysThatFindNoRoomComePageByPage) {
  ScreenText text;
  text.setKeyNames("h", "Enter");
  EXPECT_EQ(at(text, playing()).help_key, "") << "no keys are shown";
  for (const std::size_t page : {0, 1, 2}) {
    text.turnKeys({{"SPACE", "pause"}}, 3);
    EXPECT_EQ(at(text, playing()).keys_page, page);
    EXPECT_EQ(at(text, playing()).help_key, "h");
  }
  text.turnKeys({{"SPACE", "pause"}}, 3);
  EXPECT_FALSE(text.showsKeys());
  text.turnKeys({{"SPACE", "pause"}}, 3);
  EXPECT_EQ(at(text, playing()).keys_page, 0u);
  for (const auto& [by, page] : {std::pair{-1, 0u}, {1, 1u}, {1, 2u}, {1, 2u}, {-1, 1u}, {-5, 0u}, {0, 0u}}) {
    text.turnPage(by);
    EXPECT_EQ(at(text, playing()).keys_page, page);
  }
  text.hideKeys();
  EXPECT_FALSE(text.showsKeys());
}

TEST(Statistics, ListTheTracksAndMarkTheChosenOnes) {
  PlayReport report;
  const auto tracks = [&] {
    const ScreenRows rows = Statistics().rows(report, {}, MonotonicTime{});
    const auto row = std::ranges::find(rows, "tracks", &std::pair<std::string, std::string>::first);
    return row == rows.end() ? std::string() : row->second;
  };
  EXPECT_EQ(tracks(), "") << "nothing is open yet";
  report.film.color_width = 640;
  EXPECT_EQ(tracks(), "sound none, subtitles none");
  report.film.sounds = {{.language = "eng"}, {.language = "deu"}, {.language = "und"}};
  report.film.sound = 1;
  report.film.subtitles = {{.language = ""}};
  EXPECT_EQ(tracks(), "sound eng [deu] 3, subtitles 1");
}

}  // namespace
}  // namespace relievo
