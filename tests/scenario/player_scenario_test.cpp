// SPDX-License-Identifier: Apache-2.0
// Whole films in simulated time: what is shown, what is felt, and what the report says of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr const char* kWholeFilm = "boot idle opening buffering playing ended idle";

// From above the surface (code 100 is 15.7 mm of 40) to 15 mm, and there it stays: 0.7 to 2.1 mm deep.
std::vector<glm::dvec3> comingDown() {
  std::vector<glm::dvec3> path(201);
  for (std::size_t i = 0; i < path.size(); ++i) path[i] = {0, 0, 25.0 - 0.05 * static_cast<double>(i)};  // 50 mm/s
  return path;
}

// The mock's workspace is centred on z = 20, the middle of the default volume: device mm are scene mm.
class PlayerScenario : public testing::Test {
 protected:
  void playsWell() {
    const auto played = bench_.run();
    ASSERT_TRUE(played) << played.error().thing << ": " << played.error().error.message;
  }
  PlayerBench bench_;
};

TEST_F(PlayerScenario, PlaysToTheEndEveryPictureAtItsTime) {
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.report.frames_dropped, 0u);
  EXPECT_EQ(bench_.report.pairs.mismatched, 0u);
  EXPECT_NEAR(bench_.report.media_s, 4.0, 0.005);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.02);
  EXPECT_THAT(bench_.report.faults, IsEmpty());
}

TEST_F(PlayerScenario, TheFingerFeelsTheFilmAndTheForceIsZeroAfterwards) {
  bench_.haptic.path_mm = comingDown();
  playsWell();
  // 4 s at 1 kHz, less what opening took.
  EXPECT_NEAR(static_cast<double>(bench_.report.haptic.ticks), 4000, 20);
  EXPECT_GT(bench_.report.haptic.contact_ticks, 3500u);
  // The highest plane is code 109, 17.1 mm: 2.1 mm above the finger, at half a newton a millimetre.
  EXPECT_NEAR(bench_.report.haptic.max_force_n, 0.5 * (40.0 * 109 / 255 - 15.0), 0.05);
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
  EXPECT_EQ(bench_.force_left, glm::dvec3(0));
}

TEST_F(PlayerScenario, APauseStandsStillAndStaysTouchable) {
  bench_.haptic.path_mm = comingDown();
  bench_.press(1.0, KEY_PLAYPAUSE);
  bench_.press(6.0, KEY_PLAYPAUSE);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing paused playing ended idle");
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_NEAR(bench_.report.media_s, 4.0, 0.01);
  EXPECT_NEAR(bench_.report.wall_s, 9.0, 0.02);
  EXPECT_GT(bench_.report.haptic.contact_ticks, 8000u);  // all the five seconds of the pause
  EXPECT_EQ(bench_.faults("depth delayed"), 0u);
}

TEST_F(PlayerScenario, PlayAndPauseKeysSayWhatTheyMeanWhateverTheState) {
  bench_.press(1.0, KEY_PLAY);  // it plays already
  bench_.press(1.5, KEY_PAUSE);
  bench_.press(1.6, KEY_PAUSE);  // it is paused already
  bench_.press(2.0, KEY_PLAYCD);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing paused playing ended idle");
}

TEST_F(PlayerScenario, AfterEachSeekThePictureAndTheSurfaceAreOfTheSameTime) {
  bench_.sources["film"] = PlayerBench::film(1000);
  bench_.sources["film"].tracks[0].keyframe_interval = 12;
  bench_.sources["film"].tracks[1].keyframe_interval = 7;
  bench_.press(2.0, KEY_FORWARD);
  bench_.press(3.0, KEY_FORWARD);
  bench_.press(4.0, KEY_REWIND);
  bench_.press(5.0, KEY_STOP);
  playsWell();
  EXPECT_EQ(bench_.states(),
            "boot idle opening buffering playing seeking buffering playing seeking buffering playing seeking buffering "
            "playing idle");
  ASSERT_THAT(bench_.report.seeks, SizeIs(3));
  const double from[] = {2.0, 13.0, 24.0}, step[] = {10.0, 10.0, -10.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const SeekEntry& seek = bench_.report.seeks[i];
    EXPECT_NEAR(seek.target_s, from[i] + step[i], 0.05) << i;
    const double picture_s = seek.picture_s.value_or(-1);
    EXPECT_EQ(picture_s, seek.surface_s) << i;
    // The first picture at or after the target.
    EXPECT_GE(picture_s, seek.target_s) << i;
    EXPECT_LT(picture_s, seek.target_s + 0.04) << i;
    // Simulated time: decoding takes none, the feeler's next tick comes within a millisecond.
    EXPECT_LT(seek.picture_ms.value_or(1e9), 10) << i;
    EXPECT_LE(seek.picture_ms, seek.surface_ms) << i;
    EXPECT_LT(seek.surface_ms.value_or(1e9), seek.picture_ms.value_or(0) + 1.5) << i;
  }
  EXPECT_LT(bench_.report.first_touch_ms.value_or(1e9), bench_.report.first_frame_ms.value_or(0) + 10);
}

TEST_F(PlayerScenario, PressesInARowAddUpToOneSeek) {
  bench_.sources["film"] = PlayerBench::film(2000);
  for (int i = 0; i < 3; ++i) bench_.press(2.0, KEY_FORWARD);
  bench_.press(3.0, KEY_STOP);
  playsWell();
  ASSERT_THAT(bench_.report.seeks, SizeIs(3));
  EXPECT_FALSE(bench_.report.seeks[0].picture_s);
  EXPECT_FALSE(bench_.report.seeks[1].picture_s);
  EXPECT_NEAR(bench_.report.seeks[2].picture_s.value_or(0), 32.0, 0.05);
}

TEST_F(PlayerScenario, ASeekBeforeTheBeginningGoesToTheBeginning) {
  bench_.press(2.0, KEY_REWIND);
  playsWell();
  ASSERT_THAT(bench_.report.seeks, SizeIs(1));
  EXPECT_EQ(bench_.report.seeks[0].target_s, 0.0);
  EXPECT_EQ(bench_.report.seeks[0].picture_s, 0.0);
  EXPECT_EQ(bench_.report.seeks[0].surface_s, 0.0);
}

TEST_F(PlayerScenario, ASeekBeyondTheEndEndsTheFilm) {
  bench_.press(2.0, KEY_FORWARD);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing seeking buffering ended idle");
  EXPECT_THAT(bench_.report.seeks, SizeIs(1));
  EXPECT_FALSE(bench_.report.seeks[0].picture_s);
  EXPECT_EQ(bench_.faults("too early"), 0u);
}

TEST_F(PlayerScenario, ASeekWhilePausedShowsItsPictureAndStaysPaused) {
  bench_.sources["film"] = PlayerBench::film(1000);
  bench_.press(1.0, KEY_PAUSE);
  bench_.press(2.0, KEY_FORWARD);
  bench_.press(4.0, KEY_STOP);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing paused seeking buffering paused idle");
  ASSERT_THAT(bench_.report.seeks, SizeIs(1));
  EXPECT_NEAR(bench_.report.seeks[0].picture_s.value_or(0), 11.0, 0.05);
  EXPECT_EQ(bench_.report.seeks[0].picture_s, bench_.report.seeks[0].surface_s);
  EXPECT_NEAR(bench_.report.media_s, 1.0, 0.02);
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 25 + 1, 1);  // of the first second, and one
}

TEST_F(PlayerScenario, UntilTheSoughtPictureComesTheSurfaceStandsAsThePictureDoes) {
  const test::TemporaryFolder folder;
  auto recorder = Recorder::create(folder / "touch.csv");
  ASSERT_TRUE(recorder);
  bench_.recorder = &*recorder;
  bench_.sources["film"] = PlayerBench::film(1000);
  bench_.press(1.0, KEY_FORWARD);
  bench_.press(2.0, KEY_STOP);
  playsWell();
  ASSERT_TRUE(recorder->finish());

  // The film's time, the twelfth column, as each tick saw it.
  std::vector<double> times;
  std::ifstream csv(folder / "touch.csv");
  std::string line;
  std::getline(csv, line);
  while (std::getline(csv, line)) {
    std::istringstream cells(line);
    for (int i = 0; i < 12; ++i) std::getline(cells, line, ',');
    times.push_back(std::stod(line));
  }
  std::size_t jump = 1;
  while (jump < times.size() && times[jump] - times[jump - 1] < 5) ++jump;
  ASSERT_LT(jump, times.size());
  EXPECT_EQ(times[jump - 1], times[jump - 2]);  // the reader takes 2 ms at least
  EXPECT_NEAR(times[jump - 1], 1.0, 0.02);
}

TEST_F(PlayerScenario, ASeekThatTheSourceRefusesGoesOn) {
  bench_.sources["film"].live = true;
  bench_.press(1.0, KEY_FORWARD);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing seeking buffering playing ended idle");
  EXPECT_EQ(bench_.faults("seek"), 1u);
}

TEST_F(PlayerScenario, The3dModeKeyGoesRoundTheLayoutsThatTheScreenTakes) {
  double time_s = 1.0;
  // After side by side. This screen takes no frame packing.
  for (const char* layout : {"tab", "rows", "columns", "anaglyph", "quilt:8x6", "mono", "sbs"}) {
    bench_.press(time_s, KEY_3D_MODE);
    time_s += 0.2;
    playsWell();
    EXPECT_EQ(bench_.report.stereo, layout);
  }
}

TEST_F(PlayerScenario, ALayoutThatTheScreenRefusesIsToldAndAnotherIsShown) {
  bench_.config.stereo.layout = StereoLayout::FramePacking;
  playsWell();
  EXPECT_EQ(bench_.faults("stereo: frame packing needs"), 1u);
  EXPECT_EQ(bench_.report.stereo, "sbs");
}

TEST_F(PlayerScenario, LoopsWithTheSurfaceBegunAnew) {
  bench_.haptic.path_mm = comingDown();
  bench_.sources["film"] = PlayerBench::film(50);
  bench_.config.loop = true;
  bench_.config.duration = std::chrono::milliseconds(5'000);
  playsWell();
  EXPECT_EQ(bench_.states(),
            "boot idle opening buffering playing ended seeking buffering playing ended seeking buffering playing idle");
  EXPECT_NEAR(bench_.report.wall_s, 5.0, 0.01);
  EXPECT_EQ(bench_.faults("depth delayed"), 0u);
  EXPECT_THAT(bench_.report.seeks, IsEmpty());  // nobody asked for them
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
}

TEST_F(PlayerScenario, StopsWhenItsTimeIsUp) {
  bench_.config.duration = std::chrono::milliseconds(1'500);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing idle");
  EXPECT_NEAR(bench_.report.wall_s, 1.5, 0.01);
}

TEST_F(PlayerScenario, StopsAtOnceOnASignal) {
  bench_.stop = true;
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening idle");
  EXPECT_EQ(bench_.report.frames_shown, 0u);
}

TEST_F(PlayerScenario, WithoutDepthItPlaysFlatAndSaysSoOnce) {
  bench_.sources["film"].tracks.pop_back();
  bench_.haptic.path_mm = comingDown();
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.faults("no depth"), 1u);
  EXPECT_EQ(bench_.report.haptic.max_force_n, 0.0);
}

TEST_F(PlayerScenario, DepthThatEndsBeforeTheColorFadesTheForceAndThePictureGoesOn) {
  bench_.sources["film"].tracks[1].frames = 50;
  bench_.haptic.path_mm = comingDown();
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.faults("no depth at this time"), 1u);
  EXPECT_GT(bench_.report.haptic.max_force_n, 0.5);
  EXPECT_LE(bench_.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
  EXPECT_NEAR(static_cast<double>(bench_.report.haptic.contact_ticks), 2000 - 160, 150);
}

TEST_F(PlayerScenario, DepthOfALowerRateIsHeld) {
  bench_.sources["film"].tracks[1].frames = 25;
  bench_.sources["film"].tracks[1].frame_period = 4 * PlayerBench::kPeriod;
  bench_.haptic.path_mm = comingDown();
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.faults("depth delayed"), 0u);
  EXPECT_GT(bench_.report.haptic.contact_ticks, 3000u);
}

TEST_F(PlayerScenario, ColorThatIsLostStopsTheFilmWithItsReason) {
  bench_.sources["film"].lose_after_packets = 80;
  bench_.haptic.path_mm = comingDown();
  const auto played = bench_.run();
  ASSERT_FALSE(played);
  EXPECT_EQ(played.error().thing, "film");
  EXPECT_EQ(played.error().error.code, ErrorCode::Lost);
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing fault");
  EXPECT_GT(bench_.report.frames_shown, 30u);  // what was read is shown first
  EXPECT_EQ(bench_.force_left, glm::dvec3(0));
  EXPECT_EQ(bench_.faults("film"), 1u);
}

TEST_F(PlayerScenario, AFilmThatIsCutOffPlaysWhatIsThere) {
  bench_.sources["film"].end_after_packets = 81;
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.report.frames_shown, 41u);
  // 81 packets: the 41st colour picture, the last, ends at 1.64 s of 4.
  ASSERT_EQ(bench_.faults("film ends 2.4 s too early"), 1u);
  EXPECT_NEAR(bench_.report.faults.back().time_s, 1.64, 0.05);
}

TEST_F(PlayerScenario, ADepthFileThatIsCutOffIsSaidSo) {
  bench_.sources["film"].tracks.pop_back();
  bench_.sources["depth"] = {.tracks = {PlayerBench::depthTrack(100)}, .end_after_packets = 50};
  bench_.config.source.depth_url = "depth";
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.faults("depth ends 2.0 s too early"), 1u);
}

TEST_F(PlayerScenario, AFilmThatDoesNotOpenIsAFault) {
  bench_.sources["film"].fail_open = ErrorCode::NotFound;
  const auto played = bench_.run();
  ASSERT_FALSE(played);
  EXPECT_EQ(played.error().error.code, ErrorCode::NotFound);
  EXPECT_EQ(bench_.states(), "boot idle opening fault");
}

TEST_F(PlayerScenario, APhotoStandsAndStaysTouchableUntilItIsLeft) {
  bench_.sources["film"] = PlayerBench::film(1);
  bench_.haptic.path_mm = comingDown();
  bench_.press(20.0, KEY_STOP);
  bench_.config.duration = std::chrono::seconds(30);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing idle");
  EXPECT_EQ(bench_.report.frames_shown, 1u);
  EXPECT_NEAR(bench_.report.wall_s, 20.0, 0.1);
  EXPECT_GT(bench_.report.haptic.contact_ticks, 19'000u);
  EXPECT_EQ(bench_.faults("depth delayed"), 0u);
}

TEST_F(PlayerScenario, InAListAPhotoGivesWayToTheNextFilm) {
  bench_.config.source.url = "list.m3u";
  bench_.texts["list.m3u"] = "photo\nother\n";
  bench_.sources["./photo"] = PlayerBench::film(1);
  bench_.sources["./other"] = PlayerBench::film(25);
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 26u);
  EXPECT_NEAR(bench_.report.wall_s, 6.0, 0.1) << "five seconds and one";
}

// ---- sources over a network

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

TEST_F(PlayerScenario, OddSizesPlayAndAreFelt) {
  MockTrack& color = bench_.sources["film"].tracks[0];
  MockTrack& depth = bench_.sources["film"].tracks[1];
  color.width = 33;
  color.height = 17;
  depth.width = 7;
  depth.height = 5;
  bench_.haptic.path_mm = comingDown();
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  // The box has the shape of the depth picture, whatever the colour's is.
  EXPECT_NEAR(bench_.report.volume.height_mm, 160.0 * 5 / 7, 1e-9);
  EXPECT_GT(bench_.report.haptic.contact_ticks, 3500u);
}

TEST_F(PlayerScenario, TheVolumeAskedForIsTheOneFelt) {
  bench_.config.volume = DisplayVolume{100, 50, 80};
  bench_.haptic.path_mm = comingDown();
  playsWell();
  EXPECT_EQ(bench_.report.volume.depth_mm, 80);
  // The plane at code 100 stands 31.4 mm high, above the finger from the beginning: it starts inside and stays free.
  EXPECT_EQ(bench_.report.haptic.contact_ticks, 0u);
}

TEST_F(PlayerScenario, WithoutAHapticDeviceTheFilmPlays) {
  bench_.with_haptic = false;
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.report.haptic.scheduler, "none");
  EXPECT_THAT(bench_.report.faults, IsEmpty());  // nobody asked for one
}

TEST_F(PlayerScenario, AHapticDeviceThatDoesNotOpenOrHomeIsSaidAndTheFilmPlays) {
  bench_.haptic.fail_open = ErrorCode::PermissionDenied;
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.faults("haptic device"), 1u);
  bench_.haptic.fail_open.reset();
  bench_.haptic.fail_homing_after = 0;
  playsWell();
  EXPECT_EQ(bench_.faults("haptic device"), 1u);
}

// Simulated time in which the haptic device's cable is out for a while; looks at the force once a tick.
class CableClock final : public Clock {
 public:
  CableClock(MockHapticBench& hand, double out_s, double in_s) : hand_(hand), out_s_(out_s), in_s_(in_s) {}
  [[nodiscard]] MonotonicTime now() const noexcept override { return time_.now(); }
  void sleepUntil(MonotonicTime deadline) noexcept override {
    time_.sleepUntil(deadline);
    const double t_s = toSeconds(now() - MonotonicTime{});
    hand_.unplugged = t_s >= out_s_ && t_s < in_s_;
    const double force_n = glm::length(hand_.force());
    if (t_s < out_s_) before_n = force_n;
    if (t_s > out_s_ + 0.005 && t_s < in_s_) while_out_n = std::max(while_out_n, force_n);
    if (t_s >= in_s_) steepest_n = std::max(steepest_n, force_n - last_n_), last_n = force_n;
    last_n_ = force_n;
  }
  double before_n = 0, while_out_n = 0, steepest_n = 0, last_n = 0;

 private:
  ManualClock time_;
  MockHapticBench& hand_;
  double out_s_, in_s_;
  double last_n_ = 0;
};

TEST_F(PlayerScenario, AHapticDeviceThatIsPulledOutLeavesTheFilmRunning) {
  bench_.haptic.path_mm = comingDown();
  CableClock time(*bench_.hand, 1.5, 1000);
  ASSERT_TRUE(bench_.runOn(time));
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_GT(time.before_n, 0.1) << "it was in contact";
  EXPECT_EQ(time.while_out_n, 0);
  EXPECT_EQ(bench_.faults("haptic device lost"), 1u);
  EXPECT_EQ(bench_.faults("haptic device: the mock device is unplugged"), 1u) << "told once, though tried again";
  EXPECT_EQ(bench_.force_left, glm::dvec3(0));
}

TEST_F(PlayerScenario, AHapticDeviceThatComesBackIsFeltAgainByAndBy) {
  bench_.haptic.path_mm = comingDown();
  CableClock time(*bench_.hand, 1.5, 2.2);
  ASSERT_TRUE(bench_.runOn(time));
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_GT(time.before_n, 0.1);
  EXPECT_EQ(time.while_out_n, 0);
  EXPECT_EQ(bench_.faults("haptic device lost"), 1u);
  EXPECT_EQ(bench_.faults("haptic device back"), 1u);
  EXPECT_GT(time.last_n, 0.1) << "in contact again";
  EXPECT_LE(time.steepest_n, 0.051) << "50 N/s";
}

TEST_F(PlayerScenario, AHapticDeviceThatIsPluggedInLateIsFeltFromThenOn) {
  bench_.haptic.path_mm = comingDown();
  bench_.hand->unplugged = true;
  CableClock time(*bench_.hand, 0, 1.5);
  ASSERT_TRUE(bench_.runOn(time));
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.faults("haptic device"), 1u);
  EXPECT_GT(bench_.report.haptic.ticks, 1000u);
  EXPECT_GT(time.last_n, 0.1);
}

TEST_F(PlayerScenario, ADisplayThatDoesNotOpenStopsEverything) {
  bench_.display.fail_open = ErrorCode::Unsupported;
  const auto played = bench_.run();
  ASSERT_FALSE(played);
  EXPECT_THAT(played.error().thing, HasSubstr("display"));
  EXPECT_EQ(bench_.states(), "boot fault");
}

TEST_F(PlayerScenario, ADisplayThatIsLostComesBackAndTheFilmGoesOnMeanwhile) {
  bench_.display.lose_after_frames = 30;  // of each time it is open
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  // Lost after 30 pictures at 1.16 s, tried again a second later, lost after 30 more at 3.4 s, not tried again before
  // the end at 4 s.
  EXPECT_EQ(bench_.faults("display lost"), 2u);
  EXPECT_EQ(bench_.faults("display back"), 1u);
  EXPECT_EQ(bench_.report.frames_shown, 60u);
  EXPECT_EQ(bench_.report.frames_dropped, 40u);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.02);
}

TEST_F(PlayerScenario, AScreenThatIsOffAtTheStartMayComeLater) {
  bench_.display.fail_open = ErrorCode::NotFound;
  bench_.display.failing_opens = 3;  // at the start, with the first picture, and a second after that
  playsWell();
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.faults("display: "), 1u);
  EXPECT_EQ(bench_.faults("display back"), 1u);
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 50, 1);
  EXPECT_NEAR(bench_.report.wall_s, 4.0, 0.02);
}

TEST_F(PlayerScenario, AViewerWhoClosesTheWindowEndsTheFilm) {
  bench_.display.close_after_frames = 25;
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing idle");
  EXPECT_EQ(bench_.report.frames_shown, 25u);
  EXPECT_NEAR(bench_.report.media_s, 1.0, 0.05);
  EXPECT_THAT(bench_.report.faults, IsEmpty());
  EXPECT_EQ(bench_.force_left, glm::dvec3(0));
}

TEST_F(PlayerScenario, ADisplayThatWaitsForItsRefreshDropsNothing) {
  bench_.display.refresh_period = std::chrono::microseconds(16'667);
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.report.frames_dropped, 0u);
}

TEST_F(PlayerScenario, ADisplayTooSlowForTheFilmDropsPicturesAndKeepsTheTime) {
  bench_.display.refresh_period = std::chrono::milliseconds(100);  // 10 a second, the film has 25
  playsWell();
  EXPECT_EQ(bench_.report.frames_shown + bench_.report.frames_dropped, 100u);
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown), 40.0, 3.0);
  EXPECT_GE(bench_.report.wall_s, 4.0);  // and at most a refresh before the first picture and one after the last
  EXPECT_LE(bench_.report.wall_s, 4.0 + 0.21);
  EXPECT_EQ(bench_.faults("depth delayed"), 0u);  // the finger does not feel the slow screen
}

TEST_F(PlayerScenario, TheSameFilmHandAndKeysGiveTheSameRun) {
  bench_.haptic.path_mm = comingDown();
  bench_.press(1.0, KEY_REWIND);
  playsWell();
  const PlayReport first = bench_.report;
  PlayerBench again;
  again.haptic = bench_.haptic;
  again.keys = bench_.keys;
  ASSERT_TRUE(again.run());
  EXPECT_EQ(again.report.haptic.max_force_n, first.haptic.max_force_n);
  EXPECT_EQ(again.report.haptic.scene_mj, first.haptic.scene_mj);
  EXPECT_EQ(again.report.haptic.contact_ticks, first.haptic.contact_ticks);
  EXPECT_EQ(again.report.wall_s, first.wall_s);
}

// With its own threads, on the machine's clock: no figure of time is asserted, only what must come of it.
TEST_F(PlayerScenario, AnUnderrunStandsStillFadesTheForceAndGoesOn) {
  bench_.sources["film"] = PlayerBench::film(60);
  bench_.sources["film"].stall_after_packets = 60;
  bench_.sources["film"].stall = std::chrono::milliseconds(900);  // queue and look-ahead hold 8 pairs, 320 ms
  bench_.config.own_threads = true;
  MonotonicClock time;
  ASSERT_TRUE(bench_.runOn(time));
  EXPECT_THAT(bench_.states(), HasSubstr("playing buffering playing"));
  EXPECT_THAT(bench_.states(), HasSubstr("ended idle"));
  EXPECT_GE(bench_.faults("buffering: the source or this computer is too slow"), 1u);
  EXPECT_GE(bench_.faults("depth delayed"), 1u);
  EXPECT_GE(bench_.faults("depth back"), 1u);
  EXPECT_EQ(bench_.report.frames_shown + bench_.report.frames_dropped, 60u);
}

}  // namespace
}  // namespace relievo
