// SPDX-License-Identifier: Apache-2.0
// What a command asks for in each situation: the deeds in their order, without a player.
#include "app/player/control/wishes.h"

#include <gtest/gtest.h>

#include <string>

#include "app/player/control/loop_ab.h"
#include "platform/print.h"

namespace relievo {
namespace {

// "rate 1, seek 20, stand".
std::string words(const std::vector<Deed>& deeds) {
  std::string text;
  for (const Deed& deed : deeds) {
    text += text.empty() ? "" : ", ";
    switch (deed.kind) {
      case Deed::Kind::GoOn:
        text += "go on";
        break;
      case Deed::Kind::Stand:
        text += "stand";
        break;
      case Deed::Kind::StepOn:
        text += "step";
        break;
      case Deed::Kind::Rate:
        text += print("rate %g", deed.rate);
        break;
      case Deed::Kind::Seek:
        text += print("seek %g%s", toSeconds(deed.target), deed.by_viewer ? " wished" : "");
        break;
      case Deed::Kind::OpenFilm:
        text += print("film %zu%s", deed.film, deed.back ? " back" : "");
        break;
    }
  }
  return text;
}

std::string asked(PlayerVerb verb, const Situation& situation, double value = 0) {
  return words(deedsFor({.verb = verb, .value = value, .word = ""}, situation));
}

// 20 s into the middle one of three films of 100 s.
Situation playing() {
  return {.state = PlayerState::Playing,
          .here = mediaTime(20),
          .length = std::chrono::seconds(100),
          .picture = mediaTime(19.96),
          .period = std::chrono::milliseconds(40),
          .film = 1,
          .films = 3,
          .film_asked = true};
}

TEST(Wishes, ChaptersAreSoughtByTheirBeginnings) {
  const std::vector<Chapter> chapters{{fromSeconds(0), fromSeconds(18), ""},
                                      {fromSeconds(18), fromSeconds(60), ""},
                                      {fromSeconds(60), fromSeconds(90), ""}};
  Situation situation = playing();
  EXPECT_EQ(asked(PlayerVerb::ChapterBy, situation, 1), "");
  situation.chapters = chapters;
  EXPECT_EQ(asked(PlayerVerb::ChapterBy, situation, 1), "seek 60 wished");
  EXPECT_EQ(asked(PlayerVerb::ChapterBy, situation, -1), "seek 0 wished") << "near the beginning of the second";
  situation.here = mediaTime(30);
  EXPECT_EQ(asked(PlayerVerb::ChapterBy, situation, -1), "seek 18 wished");
  situation.here = mediaTime(70);
  EXPECT_EQ(asked(PlayerVerb::ChapterBy, situation, 1), "");
}

TEST(Wishes, OneKeyPausesAndGoesOn) {
  Situation s = playing();
  EXPECT_EQ(asked(PlayerVerb::PlayPause, s), "stand");
  s.held = true;
  EXPECT_EQ(asked(PlayerVerb::PlayPause, s), "go on");
  EXPECT_EQ(asked(PlayerVerb::Pause, s), "stand");
}

TEST(Wishes, WithoutAFilmPlayOpensTheOneBefore) {
  Situation s = playing();
  s.state = PlayerState::Idle;
  EXPECT_EQ(asked(PlayerVerb::Play, s), "film 1");
  EXPECT_EQ(asked(PlayerVerb::PlayPause, s), "film 1");
  s.film_asked = false;
  EXPECT_EQ(asked(PlayerVerb::Play, s), "");
}

TEST(Wishes, TheRateGoesUpAndDownTheLadderAndStaysOnIt) {
  Situation s = playing();
  EXPECT_EQ(asked(PlayerVerb::Slower, s), "rate 0.5") << "every picture: no seek";
  EXPECT_EQ(asked(PlayerVerb::Faster, s), "rate 2, seek 20") << "from here on by key frames";
  s.rate = 16;
  EXPECT_EQ(asked(PlayerVerb::Faster, s), "");
  s.rate = 0.125;
  EXPECT_EQ(asked(PlayerVerb::Slower, s), "");
}

TEST(Wishes, AFilmThatRushesStandsAtTheUsualRate) {
  Situation s = playing();
  s.rate = 4;
  EXPECT_EQ(asked(PlayerVerb::Pause, s), "rate 1, seek 20, stand");
  EXPECT_EQ(asked(PlayerVerb::Step, s), "rate 1, seek 20, stand");
  EXPECT_EQ(asked(PlayerVerb::PlayPause, s), "go on, rate 1, seek 20");
}

// A seek finds the first picture from its target on: 19.92 s, the one before.
TEST(Wishes, AStepBackSeeksBetweenTheTwoPicturesBeforeAndStands) {
  Situation s = playing();
  EXPECT_EQ(asked(PlayerVerb::StepBack, s), "stand, seek 19.9");
  s.state = PlayerState::Seeking;
  EXPECT_EQ(asked(PlayerVerb::StepBack, s), "") << "the picture before is on its way";
  s = playing();
  s.rate = 4;
  EXPECT_EQ(asked(PlayerVerb::StepBack, s), "rate 1, seek 20, stand");
}

TEST(Wishes, TheUsualSpeedIsOneKeyAway) {
  Situation s = playing();
  EXPECT_EQ(asked(PlayerVerb::NormalSpeed, s), "");
  s.rate = 0.25;
  EXPECT_EQ(asked(PlayerVerb::NormalSpeed, s), "rate 1");
  s.rate = 8;
  EXPECT_EQ(asked(PlayerVerb::NormalSpeed, s), "rate 1, seek 20");
}

TEST(Wishes, PlayInSlowMotionGoesBackToTheUsualRate) {
  Situation s = playing();
  s.rate = 0.25;
  EXPECT_EQ(asked(PlayerVerb::Play, s), "go on, rate 1");
  s.state = PlayerState::Paused;
  EXPECT_EQ(asked(PlayerVerb::Play, s), "go on, rate 1");
}

TEST(Wishes, TheRateOfAPausedFilmIsChangedAndKeptWhenItGoesOn) {
  Situation s = playing();
  s.state = PlayerState::Paused;
  s.held = true;
  EXPECT_EQ(asked(PlayerVerb::Slower, s), "rate 0.5");
  EXPECT_EQ(asked(PlayerVerb::Faster, s), "go on, rate 2, seek 20") << "key frames do not stand";
  s.rate = 0.5;
  EXPECT_EQ(asked(PlayerVerb::Faster, s), "rate 1");
  EXPECT_EQ(asked(PlayerVerb::NormalSpeed, s), "rate 1");
  EXPECT_EQ(asked(PlayerVerb::PlayPause, s), "go on");
  s.rate = 1;
  s.length = Duration(0);
  EXPECT_EQ(asked(PlayerVerb::Faster, s), "");
}

TEST(Wishes, ALiveFilmGoesNoFasterThanItComes) {
  Situation s = playing();
  s.length = Duration(0);
  EXPECT_EQ(asked(PlayerVerb::Faster, s), "");
  EXPECT_EQ(asked(PlayerVerb::SeekShare, s, 0.5), "");
  EXPECT_EQ(asked(PlayerVerb::Slower, s), "rate 0.5");
}

TEST(Wishes, SeeksCountFromHereFromZeroOrByTheLength) {
  const Situation s = playing();
  EXPECT_EQ(asked(PlayerVerb::SeekBy, s, -5), "seek 15 wished");
  EXPECT_EQ(asked(PlayerVerb::SeekTo, s, 75), "seek 75 wished");
  EXPECT_EQ(asked(PlayerVerb::SeekShare, s, 0.5), "seek 50 wished");
}

TEST(Wishes, NextOfTheLastFilmIsTheFirstWhereTheListRepeats) {
  Situation s = playing();
  EXPECT_EQ(asked(PlayerVerb::Next, s), "film 2");
  s.film = 2;
  EXPECT_EQ(asked(PlayerVerb::Next, s), "");
  s.wraps = true;
  EXPECT_EQ(asked(PlayerVerb::Next, s), "film 0");
}

TEST(Wishes, PreviousIsTheFilmBeforeOrThisOneFromItsBeginning) {
  Situation s = playing();
  EXPECT_EQ(asked(PlayerVerb::Previous, s), "seek 0 wished");
  s.here = mediaTime(2.9);
  EXPECT_EQ(asked(PlayerVerb::Previous, s), "film 0 back");
  s.film = 0;
  EXPECT_EQ(asked(PlayerVerb::Previous, s), "seek 0 wished");
}

TEST(Wishes, NextEndsWithTheList) {
  Situation s = playing();
  EXPECT_EQ(asked(PlayerVerb::Next, s), "film 2");
  s.film = 2;
  EXPECT_EQ(asked(PlayerVerb::Next, s), "");
}

TEST(MarkedPart, LiesBetweenItsTwoMarksInWhateverOrderTheyAreSet) {
  LoopAB part;
  part.mark(mediaTime(8));
  EXPECT_FALSE(part.to());
  part.mark(mediaTime(8));
  EXPECT_FALSE(part.to()) << "a part without length";
  part.mark(mediaTime(5));
  EXPECT_EQ(part.from(), mediaTime(5));
  EXPECT_EQ(part.to(), mediaTime(8));
  part.mark(mediaTime(6));
  EXPECT_FALSE(part.from());
}

TEST(MarkedPart, OutlivesOneSlowRoundButNotPicturesThatAreAlwaysBehindIt) {
  LoopAB part;
  part.mark(mediaTime(5));
  part.mark(mediaTime(5.2));
  for (const double slow_s : {5.3, 5.5}) EXPECT_EQ(part.backFrom(mediaTime(slow_s)), mediaTime(5));
  EXPECT_FALSE(part.backFrom(mediaTime(5.1)));
  for (int i = 0; i < 3; ++i) EXPECT_EQ(part.backFrom(mediaTime(5.3)), mediaTime(5));
  EXPECT_FALSE(part.backFrom(mediaTime(5.3)));
  EXPECT_FALSE(part.from());
}

}  // namespace
}  // namespace relievo
