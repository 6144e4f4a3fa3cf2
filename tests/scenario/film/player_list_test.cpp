// SPDX-License-Identifier: Apache-2.0
// Lists of films: their order, and a player that waits for the next, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <glm/geometric.hpp>

#include "tests/scenario/film/player_transport.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

class PlayerLists : public PlayerTransport {};

TEST_F(PlayerLists, AListIsPlayedFromItsFirstFilmToItsLast) {
  aList();
  playsWell();
  EXPECT_EQ(
      bench_.states(),
      "boot idle opening buffering playing ended opening buffering playing ended opening buffering playing ended idle");
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "./b", "./c"));
  EXPECT_EQ(bench_.report.frames_shown, 150u);
  EXPECT_EQ(bench_.report.pairs.pairs, 150u);
  EXPECT_EQ(bench_.report.pairs.mismatched, 0u);
  EXPECT_NEAR(bench_.report.media_s, 6.0, 0.02);
  EXPECT_THAT(bench_.report.faults, IsEmpty());
}

TEST_F(PlayerLists, AStartBehindTheEndIsPassedOverWithALine) {
  bench_.config.start = mediaTime(60);
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.faults("the film ends at 4.0 s, before 60.0 s"), 1u);
}

TEST_F(PlayerLists, AListOnLoopBeginsAgain) {
  aList();
  bench_.config.loop = true;
  bench_.config.duration = std::chrono::seconds(10);
  playsWell();
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "./b", "./c", "./a", "./b", "./c"));
}

TEST_F(PlayerLists, OnLoopTheNextOfTheLastFilmIsTheFirst) {
  aList();
  bench_.config.loop = true;
  bench_.config.duration = std::chrono::seconds(5);
  bench_.press(4.0, KEY_NEXT);  // a second into the last one
  playsWell();
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "./b", "./c", "./a"));
}

TEST_F(PlayerLists, OnLoopAFilmThatCannotBeSoughtIsOpenedAgain) {
  bench_.sources["film"] = PlayerBench::film(50);
  bench_.sources["film"].live = true;
  bench_.config.loop = true;
  bench_.config.duration = std::chrono::seconds(5);
  playsWell();
  EXPECT_THAT(bench_.report.films, ElementsAre("film", "film", "film"));
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 125, 5);
}

TEST_F(PlayerLists, NextAndPreviousGoFromFilmToFilm) {
  aList();
  bench_.sources["./b"] = PlayerBench::film(500);
  bench_.press(0.5, KEY_NEXT);      // to b
  bench_.press(4.5, KEY_PREVIOUS);  // more than 3 s into it: its beginning
  bench_.press(5.0, KEY_PREVIOUS);  // to a
  bench_.press(5.5, KEY_NEXTSONG);
  bench_.press(6.0, KEY_CHANNELUP);
  bench_.press(6.5, KEY_NEXT);  // there is none
  playsWell();
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "./b", "./a", "./b", "./c"));
  ASSERT_THAT(bench_.report.seeks, SizeIs(1));
  EXPECT_EQ(bench_.report.seeks[0].target_s, 0.0);
}

TEST_F(PlayerLists, TheForceIsZeroBetweenFilmsAndFadesInOnTheNext) {
  aList();
  bench_.sources["./b"].tracks[0].width = 24;  // another shape: another volume
  bench_.sources["./b"].tracks[1].width = 24;
  aFingerInside();
  playsWell();
  EXPECT_GT(bench_.report.haptic.contact_ticks, 1000u);
  EXPECT_NEAR(static_cast<double>(bench_.report.haptic.ticks), 6000, 30);
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
  EXPECT_EQ(bench_.force_left, glm::dvec3(0));
}

TEST_F(PlayerLists, PastTheLastFilmThereIsNoNext) {
  aList();
  for (const double at_s : {0.2, 0.4, 0.6, 0.8}) bench_.press(at_s, KEY_NEXT);
  playsWell();
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "./b", "./c"));
  EXPECT_NEAR(bench_.report.media_s, 0.4 + 3.0, 0.1);
}

TEST_F(PlayerLists, AListOnLoopGoesOnWithoutAScreen) {
  aList();
  bench_.config.loop = true;
  bench_.config.duration = std::chrono::seconds(13);
  bench_.display.shown = [this] { bench_.cable->unplugged = true; };
  playsWell();
  EXPECT_THAT(bench_.report.films, SizeIs(7));
}

TEST_F(PlayerLists, AFilmIsFeltByItsOwnCalibration) {
  aList();
  MockTrack& deeper = bench_.sources["./b"].tracks[1];  // the same heights in other codes
  deeper.bits = 16;
  deeper.sample = [](int frame, int, int, int) { return static_cast<std::uint16_t>(257 * (100 + frame % 10)); };
  double hardest_n = 0;
  bench_.haptic.position_mm = [&](double t) {
    hardest_n = std::max(hardest_n, bench_.hand->force().z);
    return glm::dvec3(0, 0, t < 0.3 ? 60 : 15);
  };
  playsWell();
  EXPECT_GT(hardest_n, 0.1);
  EXPECT_LT(hardest_n, 3.0) << "2.1 mm inside, not 25";
}

TEST_F(PlayerLists, WhatIsDroppedOnTheWindowIsPlayedInstead) {
  bench_.sources = {{"film", PlayerBench::film(100)}, {"b", PlayerBench::film(25)}, {"c", PlayerBench::film(25)}};
  std::vector<std::string> drop{"b", "c"};
  bench_.display.dropped = [&] {
    const bool now = bench_.clock.now().time_since_epoch() > std::chrono::seconds(1);
    return now ? std::exchange(drop, {}) : std::vector<std::string>();
  };
  std::vector<std::string> titles;
  bench_.display.announced = [&](const AnnouncedFilm& film) { titles.push_back(film.title); };
  playsWell();
  EXPECT_THAT(bench_.report.films, testing::ElementsAre("film", "b", "c"));
  EXPECT_EQ(titles, (std::vector<std::string>{"film", "b", "c"}));
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 25 + 25 + 25, 2);
}

TEST_F(PlayerLists, SubtitlesDroppedWithAFilmAreShownWithIt) {
  bench_.sources = {{"film", PlayerBench::film(100)}, {"b", PlayerBench::film(25)}, {"b.srt", {}}};
  std::vector<std::string> drop{"b.srt", "b"};
  bench_.display.dropped = [&] {
    const bool now = bench_.clock.now().time_since_epoch() > std::chrono::seconds(1);
    return now ? std::exchange(drop, {}) : std::vector<std::string>();
  };
  playsWell();
  EXPECT_THAT(bench_.report.films, testing::ElementsAre("film", "b")) << "they are not played as a film";
  EXPECT_EQ(bench_.faults("subtitles 1 of 1, b.srt: "), 1u) << "nothing here decodes them";
}

TEST_F(PlayerLists, SeveralSourcesArePlayedOneAfterTheOther) {
  bench_.sources = {{"film", PlayerBench::film(25)}, {"b", PlayerBench::film(25)}, {"c", PlayerBench::film(25)}};
  bench_.config.more = {"b", "c"};
  playsWell();
  EXPECT_THAT(bench_.report.films, testing::ElementsAre("film", "b", "c"));
}

TEST_F(PlayerLists, AListInAListIsPlayedInItsPlace) {
  aList();
  bench_.texts["./inner.m3u"] = "b\nc\n";
  bench_.texts["list.m3u"] = "inner.m3u\na\n";
  playsWell();
  EXPECT_THAT(bench_.report.films, ElementsAre("./b", "./c", "./a"));
}

TEST_F(PlayerLists, APlayerThatStaysWaitsForTheNextFilm) {
  bench_.config.stays = true;
  bench_.config.duration = std::chrono::seconds(20);
  bench_.press(6.0, KEY_PLAY);  // the same again; it ended at 4
  bench_.press(7.0, KEY_STOP);
  bench_.press(8.0, KEY_OK);
  playsWell();
  EXPECT_EQ(
      bench_.states(),
      "boot idle opening buffering playing ended idle opening buffering playing idle opening buffering playing ended "
      "idle");
  EXPECT_NEAR(bench_.report.wall_s, 20.0, 0.02);
  EXPECT_NEAR(bench_.report.media_s, 9.0, 0.1);
}

}  // namespace
}  // namespace relievo
