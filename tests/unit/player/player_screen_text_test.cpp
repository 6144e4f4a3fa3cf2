// SPDX-License-Identifier: Apache-2.0
// What the screen says, and when it falls silent.
#include "app/player/screen/screen_text.h"

#include <gtest/gtest.h>

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
          .haptic = "Novint Falcon",
          .contact = true};
}

using Lines = std::vector<std::string>;

TEST(ScreenText, TellsTitleTimeStereoAndTouch) {
  ScreenText text;
  text.wake(kStart);
  EXPECT_EQ(text.lines(playing(), kStart),
            (Lines{"film.mkv   1:23 / 1:02:05", "3D: tab", "touch: Novint Falcon, in contact"}));
}

TEST(ScreenText, TellsSpeedAndPlaceInTheList) {
  ScreenText text;
  text.wake(kStart);
  ScreenFacts facts = playing();
  facts.rate = 4;
  facts.film = 2;
  facts.films = 5;
  EXPECT_EQ(text.lines(facts, kStart)[0], "film.mkv   1:23 / 1:02:05   4x   film 2 of 5");
  facts = playing();
  facts.rate = 0.125;
  facts.loop = true;
  EXPECT_EQ(text.lines(facts, kStart)[0], "film.mkv   1:23 / 1:02:05   1/8x   again and again");
}

TEST(ScreenText, FallsSilentFourSecondsAfterTheLastKey) {
  ScreenText text;
  EXPECT_TRUE(text.lines(playing(), kStart).empty());
  text.wake(kStart);
  EXPECT_FALSE(text.lines(playing(), kStart + seconds(3)).empty());
  EXPECT_TRUE(text.lines(playing(), kStart + seconds(4)).empty());
}

TEST(ScreenText, StaysWhileTheFilmIsHeldAndOnWish) {
  ScreenText text;
  ScreenFacts facts = playing();
  facts.held = true;
  ASSERT_FALSE(text.lines(facts, kStart).empty());
  EXPECT_EQ(text.lines(facts, kStart)[0], "film.mkv   1:23 / 1:02:05   paused");
  text.toggle();
  EXPECT_FALSE(text.lines(playing(), kStart).empty());
  text.toggle();
  EXPECT_TRUE(text.lines(playing(), kStart).empty());
}

TEST(ScreenText, TellsOnceWhatWentWrong) {
  ScreenText text;
  text.tell("device lost", kStart);
  EXPECT_EQ(text.lines(playing(), kStart + seconds(7)).back(), "device lost");
  EXPECT_TRUE(text.lines(playing(), kStart + seconds(8)).empty());
  text.wake(kStart + seconds(9));
  EXPECT_EQ(text.lines(playing(), kStart + seconds(9)).back(), "touch: Novint Falcon, in contact");
}

TEST(ScreenText, TellsWhyThereIsNothingToSeeOrFeel) {
  ScreenText text;
  text.wake(kStart);
  ScreenFacts facts = playing();
  facts.state = PlayerState::Buffering;
  facts.duration_s = 0;
  facts.has_depth = false;
  facts.stereo = {.layout = StereoLayout::Mono};
  EXPECT_EQ(text.lines(facts, kStart), (Lines{"film.mkv   1:23   buffering", "3D: mono, flat: the film has no depth",
                                              "touch: Novint Falcon, nothing to feel"}));
  facts.haptic.clear();
  facts.has_depth = true;
  facts.stereo.swap_eyes = true;
  facts.stereo.strength = 0.7;
  EXPECT_EQ(text.lines(facts, kStart)[1], "3D: mono, eyes swapped, depth 70 %");
  EXPECT_EQ(text.lines(facts, kStart)[2], "touch: no device");
}

}  // namespace
}  // namespace relievo
