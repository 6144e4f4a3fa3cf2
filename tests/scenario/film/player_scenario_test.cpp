// SPDX-License-Identifier: Apache-2.0
// Whole films in simulated time: what is shown, what is felt, and what the report says of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/scenario/film/player_scenario.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

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
  EXPECT_NEAR(bench_.report.wall_s, 4.5, 0.02) << "paused from 1.5 to 2.0 s";
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
  EXPECT_EQ(bench_.faults("lacks"), 0u);
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
  ASSERT_TRUE(recorder->file().commit());

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
  for (const char* layout : {"tab", "rows", "columns", "anaglyph", "mono", "sbs"}) {
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
  playsInPart("film");
  EXPECT_EQ(bench_.states(), kWholeFilm);
  EXPECT_EQ(bench_.report.frames_shown, 41u);
  // 81 packets: the 41st colour picture, the last, ends at 1.64 s of 4.
  ASSERT_EQ(bench_.faults("film lacks at least 2.4 s"), 1u);
  EXPECT_NEAR(bench_.report.faults.back().time_s, 1.64, 0.05);
}

// A seek may land within a picture, which counts as damaged, too.
TEST_F(PlayerScenario, AFilmWithDamagedPicturesIsNotWholeUnlessItWasSought) {
  bench_.sources["film"].damaged_every = 61;
  playsInPart("film");
  EXPECT_EQ(bench_.faults("film: 3 damaged packets or pictures were left out"), 1u);
  PlayerBench sought;
  sought.sources["film"].damaged_every = 61;
  sought.press(1.0, KEY_RIGHT);
  EXPECT_TRUE(sought.run());
  EXPECT_EQ(sought.faults("damaged packets or pictures were left out"), 1u);
}

TEST_F(PlayerScenario, ADepthFileThatIsCutOffIsSaidSo) {
  bench_.sources["film"].tracks.pop_back();
  bench_.sources["depth"] = {.tracks = {PlayerBench::depthTrack(100)}, .end_after_packets = 50};
  bench_.config.source.depth_url = "depth";
  playsInPart("depth");
  EXPECT_EQ(bench_.report.frames_shown, 100u);
  EXPECT_EQ(bench_.faults("depth lacks at least 2.0 s"), 1u);
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

TEST_F(PlayerScenario, ASeekInAPhotoLeavesItAsItIs) {
  bench_.sources["film"] = PlayerBench::film(1);
  bench_.press(1.0, KEY_RIGHT);
  bench_.press(2.0, KEY_COMMA);
  bench_.press(10.0, KEY_STOP);
  bench_.config.duration = std::chrono::seconds(30);
  playsWell();
  EXPECT_EQ(bench_.states(), "boot idle opening buffering playing paused idle") << "a step back stands";
  EXPECT_THAT(bench_.report.seeks, IsEmpty());
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

}  // namespace
}  // namespace relievo
