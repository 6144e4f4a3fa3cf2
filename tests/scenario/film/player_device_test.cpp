// SPDX-License-Identifier: Apache-2.0
// Screens and haptic devices that are missing, lost, late or slow while a film plays, in simulated time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include "tests/scenario/film/player_scenario.h"
#include "tests/scenario/player_bench.h"

namespace relievo {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

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
  // The box has the shape of the colour picture, whatever the depth's is.
  EXPECT_NEAR(bench_.report.volume.height_mm, 160.0 * 17 / 33, 1e-9);
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
