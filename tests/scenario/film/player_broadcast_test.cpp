// SPDX-License-Identifier: Apache-2.0
// Films over a network in simulated time: times that jump, lines that are lost and found again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <string>

#include "tests/scenario/film/player_scenario.h"
#include "tests/scenario/player_bench.h"

namespace relievo {
namespace {

using testing::SizeIs;

MockMediaProfile broadcast(int frames) {
  MockMediaProfile film = PlayerBench::film(frames);
  film.live = film.remote = true;
  film.longest_gap = std::chrono::seconds(2);
  return film;
}

TEST_F(PlayerScenario, ABroadcastWhoseTimesJumpGoesOn) {
  for (const Duration jump : {Duration(std::chrono::hours(3)), Duration(std::chrono::seconds(-1))}) {
    PlayerBench bench;
    bench.sources["film"] = broadcast(100);
    bench.sources["film"].jump_after_packets = 101;  // between a colour picture and its depth
    bench.sources["film"].jump = jump;
    bench.haptic.path_mm = comingDown();
    ASSERT_TRUE(bench.run());
    EXPECT_EQ(bench.states(), kWholeFilm);
    EXPECT_EQ(bench.report.frames_shown, 100u);
    EXPECT_EQ(bench.report.frames_dropped, 0u);
    EXPECT_NEAR(bench.report.wall_s, 4.0, 0.05);
    EXPECT_EQ(bench.report.pairs.jumps, 1u);
    EXPECT_EQ(bench.report.pairs.mismatched, 0u);
    EXPECT_EQ(bench.faults("depth delayed"), 0u);
    EXPECT_GT(bench.report.haptic.contact_ticks, 3400u);
  }
}

TEST_F(PlayerScenario, ABroadcastWhoseClockWrapsGoesOn) {
  bench_.sources["film"] = broadcast(100);
  bench_.sources["film"].wrap = std::chrono::milliseconds(1280);  // in pictures 32, 64 and 96
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.05);
  EXPECT_EQ(bench_.report.pairs.jumps, 3u);
  EXPECT_EQ(bench_.report.pairs.mismatched, 0u);
}

TEST_F(PlayerScenario, PicturesAtUnevenTimesAreShownAtTheirTimes) {
  bench_.sources["film"].tracks[0].missing = {3, 4, 5, 20, 40, 41, 42, 43, 44, 45, 46, 47, 48, 49};
  bench_.sources["film"].tracks[1].missing = bench_.sources["film"].tracks[0].missing;
  bench_.haptic.path_mm = comingDown();
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.report.frames_shown, 86u);
  EXPECT_EQ(bench_.report.frames_dropped, 0u);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.02);
  EXPECT_EQ(bench_.faults("depth delayed"), 0u);
}

// 40 pairs, then the line is dead; 0.25 s later it is tried again and begins a session of its own.
TEST_F(PlayerScenario, ABroadcastThatIsLostIsFoundAgainAndGoesOn) {
  bench_.sources["film"] = broadcast(100);
  bench_.sources["film"].lose_after_packets = 80;
  bench_.found_again = {broadcast(60)};
  bench_.found_again[0].tracks[0].first_pts = bench_.found_again[0].tracks[1].first_pts = std::chrono::seconds(5);
  bench_.haptic.position_mm = [](double t_s) { return glm::dvec3(0, 0, 20 - 5 * std::cos(6 * t_s)); };
  bench_.config.duration = std::chrono::seconds(10);
  const auto played = bench_.run();
  ASSERT_TRUE(played);
  EXPECT_EQ(bench_.report.pairs.reconnects, 1u);
  EXPECT_EQ(bench_.faults("film lost: the mock source has gone away"), 1u);
  EXPECT_EQ(bench_.faults("film found again"), 1u);
  EXPECT_GE(bench_.report.frames_shown, 39u + 60u);
  EXPECT_EQ(bench_.report.pairs.mismatched, 0u);
  // Four pairs in the queue and four ahead last longer than the first wait: nobody sees that it was away.
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.faults("buffering"), 0u);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.1);
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
}

TEST_F(PlayerScenario, WhileABroadcastIsAwayThePictureStandsAndTheForceFades) {
  bench_.sources["film"] = broadcast(100);
  bench_.sources["film"].lose_after_packets = 80;
  MockMediaProfile away = broadcast(60);
  away.fail_open = ErrorCode::Io;
  bench_.found_again = {away, away, away, broadcast(60)};  // tried four times, 0.25 s apart
  bench_.haptic.position_mm = [](double t_s) { return glm::dvec3(0, 0, 20 - 5 * std::cos(6 * t_s)); };
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing buffering playing ended idle");
  EXPECT_EQ(bench_.report.pairs.reconnects, 1u);
  EXPECT_EQ(bench_.faults("depth delayed"), 1u);
  EXPECT_EQ(bench_.faults("depth back"), 1u);
  EXPECT_GE(bench_.report.frames_shown, 39u + 60u);
  const auto timeOf = [&](const std::string& what) {
    for (const FaultEntry& f : bench_.report.faults) {
      if (f.what.find(what) != std::string::npos) return f.time_s;
    }
    return -1.0;
  };
  EXPECT_NEAR(timeOf("found again") - timeOf("lost: "), 1.0, 0.02);
  EXPECT_NEAR(timeOf("depth back") - timeOf("found again"), 0.0, 0.05);
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
}

TEST_F(PlayerScenario, WhileAFilmWaitsForItsSourceAKeyIsAnsweredOnTheScreen) {
  bench_.sources["film"] = PlayerBench::film(1000);
  bench_.sources["film"].remote = true;
  bench_.sources["film"].lose_after_packets = 500;  // 10 s of both tracks
  MockMediaProfile away = bench_.sources["film"];
  away.fail_open = ErrorCode::Io;
  bench_.found_again = {away};
  std::vector<double> shown_s;
  bench_.display.shown = [&] { shown_s.push_back(toSeconds(bench_.clock.now().time_since_epoch())); };
  const auto isShownAt = [&](double from_s) {
    return std::ranges::any_of(shown_s, [&](double at_s) { return at_s >= from_s && at_s < from_s + 0.1; });
  };
  bench_.press(15.0, KEY_VOLUMEUP);
  bench_.press(20.0, KEY_LEFT);  // a seek that waits
  bench_.press(24.0, KEY_VOLUMEUP);
  bench_.press(30.0, KEY_STOP);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing buffering seeking buffering idle");
  EXPECT_TRUE(isShownAt(15));
  EXPECT_FALSE(isShownAt(19)) << "nothing changes";
  EXPECT_TRUE(isShownAt(24));
}

TEST_F(PlayerScenario, ABroadcastThatStaysAwayStopsTheFilmWithItsReason) {
  bench_.sources["film"] = broadcast(100);
  bench_.sources["film"].lose_after_packets = 80;
  bench_.found_again = {broadcast(60)};
  bench_.found_again[0].fail_open = ErrorCode::Io;
  const auto played = bench_.run();
  ASSERT_FALSE(played);
  EXPECT_EQ(played.error().thing, "film");
  EXPECT_EQ(played.error().error.code, ErrorCode::Lost);
  EXPECT_EQ(bench_.report.pairs.reconnects, 0u);
  EXPECT_GT(bench_.report.wall_s, 30.0);
  EXPECT_LT(bench_.report.wall_s, 1.6 + 30.0 + 4.1);
  EXPECT_EQ(bench_.force_left, glm::dvec3(0));
}

TEST_F(PlayerScenario, AFilmOnAServerGoesOnWhereItWas) {
  bench_.sources["film"].remote = true;
  bench_.sources["film"].lose_after_packets = 81;  // the 41st colour picture without its depth
  bench_.found_again = {PlayerBench::film(100)};
  bench_.found_again[0].remote = true;
  bench_.haptic.path_mm = comingDown();
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.report.pairs.pairs, 100u);
  EXPECT_EQ(bench_.report.pairs.without_depth, 0u);
  EXPECT_EQ(bench_.report.pairs.reconnects, 1u);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.02);
}

TEST_F(PlayerScenario, ASeekWhileAServerIsAwayIsCarriedOutOnceItIsBack) {
  bench_.sources["film"] = PlayerBench::film(1000);
  bench_.sources["film"].remote = true;
  bench_.sources["film"].lose_after_packets = 80;
  MockMediaProfile away = PlayerBench::film(1000);
  away.remote = true;
  bench_.found_again = {away, away, away};
  bench_.found_again[0].fail_open = bench_.found_again[1].fail_open = ErrorCode::Io;
  bench_.press(1.8, KEY_FORWARD);
  bench_.press(5.0, KEY_STOP);
  playsWell();
  ASSERT_THAT(bench_.report.seeks, SizeIs(1));
  EXPECT_NEAR(bench_.report.seeks[0].picture_s.value_or(0), bench_.report.seeks[0].target_s, 0.04);
  EXPECT_EQ(bench_.report.seeks[0].picture_s, bench_.report.seeks[0].surface_s);
}

// Two broadcasts; the depth's is away for 0.75 s, which the colour does not feel.
TEST_F(PlayerScenario, DepthThatIsLostAloneIsFoundAgainWhileTheFilmGoesOnFlat) {
  bench_.sources["film"] = broadcast(100);
  bench_.sources["film"].tracks.pop_back();
  MockMediaProfile depth = broadcast(100);
  depth.tracks = {PlayerBench::depthTrack(100)};
  bench_.config.source.depth_url = "depth";
  bench_.sources["depth"] = depth;
  bench_.sources["depth"].lose_after_packets = 30;
  bench_.found_again = {depth, depth};
  bench_.found_again[0].fail_open = ErrorCode::Timeout;
  bench_.haptic.position_mm = [](double t_s) { return glm::dvec3(0, 0, 20 - 5 * std::cos(6 * t_s)); };
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.02);
  EXPECT_EQ(bench_.report.pairs.reconnects, 0u);
  EXPECT_EQ(bench_.report.pairs.depth_reconnects, 1u);
  EXPECT_EQ(bench_.faults("depth lost: "), 1u);
  EXPECT_EQ(bench_.faults("depth found again"), 1u);
  EXPECT_EQ(bench_.faults("no depth at this time"), 1u);
  // 0.5 s of 25 pictures a second.
  EXPECT_NEAR(static_cast<double>(bench_.report.pairs.without_depth), 13, 3);
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
}

}  // namespace
}  // namespace relievo
