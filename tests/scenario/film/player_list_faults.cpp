// SPDX-License-Identifier: Apache-2.0
// Films of a list that cannot be played, and lists that are none, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "tests/scenario/film/player_transport.h"

namespace relievo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class PlayerListFaults : public PlayerTransport {
 protected:
  // All that can be played is played; the run ends with the failure of this film.
  void playsAllBut(const char* missing) {
    const auto played = bench_.run();
    ASSERT_FALSE(played);
    EXPECT_EQ(played.error().thing, missing);
  }
};

TEST_F(PlayerListFaults, AStartIsOfTheFirstFilmAloneAlsoIfItCannotBePlayed) {
  bench_.sources["other"] = PlayerBench::film(50);
  bench_.sources.erase("film");
  bench_.config.more = {"other"};
  bench_.config.start = mediaTime(1);
  playsAllBut("film");
  EXPECT_EQ(bench_.report.frames_shown, 50u);
}

TEST_F(PlayerListFaults, AMissingOneOfSeveralSourcesIsAFailureAfterTheOthers) {
  for (const char* missing : {"film", "b", "c"}) {
    bench_.sources = {{"film", PlayerBench::film(25)}, {"b", PlayerBench::film(25)}, {"c", PlayerBench::film(25)}};
    bench_.sources.erase(missing);
    bench_.config.more = {"b", "c"};
    playsAllBut(missing);
    EXPECT_THAT(bench_.report.films, testing::ElementsAre("film", "b", "c"));
    EXPECT_EQ(bench_.report.frames_shown, 50u) << missing;
  }
}

TEST_F(PlayerListFaults, AFilmThatCannotBePlayedIsPassedOver) {
  aList();
  bench_.sources.erase("./b");
  playsAllBut("./b");
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "./b", "./c"));
  EXPECT_EQ(bench_.faults("./b"), 1u);
  EXPECT_EQ(bench_.report.frames_shown, 100u);
}

TEST_F(PlayerListFaults, AMissingLastFilmIsPassedOverAsWell) {
  aList();
  bench_.sources.erase("./c");
  playsAllBut("./c");
  EXPECT_EQ(bench_.faults("./c"), 1u);
  EXPECT_EQ(bench_.report.frames_shown, 75u);
  bench_.config.loop = true;
  bench_.config.duration = std::chrono::seconds(5);
  playsAllBut("./c");
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "./b", "./c", "./a", "./b"));
}

TEST_F(PlayerListFaults, OfTwoMissingFilmsTheFirstIsTheFailureAndBothAreReported) {
  aList();
  bench_.sources.erase("./a");
  bench_.sources.erase("./c");
  testing::internal::CaptureStderr();
  playsAllBut("./a");
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("./c: "));
  EXPECT_EQ(bench_.faults("./a") + bench_.faults("./c"), 2u);
  EXPECT_EQ(bench_.report.frames_shown, 50u);
}

// A film that is missing gets its own line alone.
TEST_F(PlayerListFaults, ThatItPlaysOffScreenIsSaidOnceAndOnlyOfAFilmThatPlays) {
  const auto times_said = [&] {
    setLogLevel(LogLevel::Info);
    bench_.config.unseen = true;
    testing::internal::CaptureStderr();
    EXPECT_EQ(bench_.run().has_value(), bench_.sources.contains("./a"));
    const std::string words = testing::internal::GetCapturedStderr();
    setLogLevel(LogLevel::Error);
    int times = 0;
    for (std::size_t at = 0; (at = words.find("off screen", at)) != std::string::npos; ++at) ++times;
    return times;
  };
  aList();
  EXPECT_EQ(times_said(), 1);
  for (const char* film : {"./a", "./b", "./c"}) bench_.sources.erase(film);
  EXPECT_EQ(times_said(), 0);
}

TEST_F(PlayerListFaults, BackwardsWhatIsMissingIsPassedOverBackwards) {
  aList();
  bench_.sources.erase("./b");
  bench_.press(2.0, KEY_PREVIOUS);  // out of c
  playsAllBut("./b");
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "./b", "./c", "./b", "./a", "./b", "./c"));
}

TEST_F(PlayerListFaults, AListThatNamesItselfEnds) {
  bench_.texts["./self.m3u"] = "self.m3u\n";
  bench_.config.source.url = "./self.m3u";
  const auto played = bench_.run();
  ASSERT_FALSE(played);
  EXPECT_THAT(played.error().error.message, HasSubstr("may contain itself"));
}

TEST_F(PlayerListFaults, AListOfWhichNothingCanBePlayedFails) {
  aList();
  bench_.sources.clear();
  bench_.config.loop = true;
  playsAllBut("./a");
}

// As a folder whose pictures have been deleted while they played.
TEST_F(PlayerListFaults, OnLoopAFilmThatGivesNoMorePicturesFails) {
  bench_.sources["film"].end_after_packets = 200;
  bench_.config.loop = true;
  bench_.config.duration = std::chrono::seconds(10);
  const auto played = bench_.run();
  ASSERT_FALSE(played);
  EXPECT_EQ(played.error().thing, "film");
  EXPECT_THAT(played.error().error.message, HasSubstr("without a single picture"));
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing ended seeking buffering fault");
}

TEST_F(PlayerListFaults, AListThatNamesFilesOfTheBoxFromTheNetworkOpensNothing) {
  bench_.texts["http://host/list.m3u"] = "#EXTM3U\nfile:///etc/passwd\n";
  bench_.sources["file:///etc/passwd"] = bench_.sources["film"];
  bench_.config.source.url = "http://host/list.m3u";
  playsAllBut("file:///etc/passwd");
  EXPECT_EQ(bench_.states(), "boot idle opening fault");
}

TEST_F(PlayerListFaults, WhatAListMayNotNameIsPassedOver) {
  aList();
  bench_.texts["list.m3u"] = "#EXTM3U\na\nconcat:a|b\nb\n";
  playsAllBut("concat:a|b");
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "concat:a|b", "./b"));
  EXPECT_EQ(bench_.faults("concat:a|b: not allowed in a playlist"), 1u);
}

TEST_F(PlayerListFaults, AllThatAListMayNotNameIsPassedOver) {
  aList();
  bench_.texts["list.m3u"] = "#EXTM3U\na\nconcat:a|b\nconcat:b|c\nb\n";
  playsAllBut("concat:a|b");
  EXPECT_THAT(bench_.report.films, ElementsAre("./a", "concat:a|b", "concat:b|c", "./b"));
  EXPECT_EQ(bench_.report.frames_shown, 75u);
}

TEST_F(PlayerListFaults, APlayerThatStaysOutlivesAFilmThatFails) {
  bench_.config.stays = true;
  bench_.config.duration = std::chrono::seconds(5);
  bench_.sources.clear();
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening fault idle");
  EXPECT_EQ(bench_.faults("film"), 1u);
}

}  // namespace
}  // namespace relievo
