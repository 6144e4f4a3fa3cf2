// SPDX-License-Identifier: Apache-2.0
// The report's fields, read back as a program would; and the recorder's lines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/player/report.h"
#include "app/player/touch/recorder.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using nlohmann::json;
using testing::HasSubstr;

PlayReport example() {
  PlayReport r;
  r.source = "film.mkv";
  r.wall_s = 2.5;
  r.media_s = 2.0;
  r.frames_shown = 58;
  r.frames_dropped = 2;
  r.pairs.mismatched = 1;
  r.first_frame_ms = 123.0;
  r.haptic.device = "sim";
  r.haptic.scheduler = "SCHED_FIFO";
  r.haptic.rate_hz = 1000;
  r.haptic.ticks = 2400;
  r.haptic.contact_ticks = 600;
  r.haptic.overruns = 3;
  r.haptic.update = {1000, 2000, 3000, 4000};
  r.haptic.wakeup = {5000, 6000, 7000, 8000};
  r.haptic.wakeup_histogram = {{5000, 3}, {8000, 1}};
  r.haptic.memory = {.task = 600, .method = 50, .stack = 40, .counters = 30, .stack_used = 7};
  r.haptic.max_force_n = 1.25;
  r.haptic.max_scene_slew_n_per_s = 49.5;
  r.haptic.scene_mj = 2.0;
  r.haptic.artefact_mj = 0.5;
  r.sound = {.device = "alsa", .rate_hz = 48000, .underruns = 1, .realigned = 2, .pictures = 50, .max_offset_ms = 12.5};
  r.states = {PlayerState::Boot, PlayerState::Idle, PlayerState::Opening};
  r.seeks = {{10.0, 10.04, 10.04, 45.5, 46.5}, {0.0, {}, {}}};
  return r;
}

TEST(Report, HasTheTimeUntilADeviceToldAContact) {
  PlayReport r = example();
  r.haptic.contact_told = {1, 2, 3, 4};
  EXPECT_EQ(json::parse(toJson(r))["haptic"]["contact_told_ns"],
            (json{{"p50", 1}, {"p99", 2}, {"p999", 3}, {"max", 4}}));
}

TEST(Report, HoldsTheFieldsThatProgramsReadAtTheirPlaces) {
  const json j = json::parse(toJson(example()));
  EXPECT_EQ(j["video"]["frames_shown"], 58);
  EXPECT_EQ(j["video"]["frames_dropped"], 2);
  EXPECT_EQ(j["video"]["pairs_mismatched"], 1);
  EXPECT_EQ(j["video"]["first_frame_ms"], 123.0);
  EXPECT_EQ(j["haptic"]["scheduler"], "SCHED_FIFO");
  EXPECT_EQ(j["haptic"]["rate_hz"], 1000.0);
  EXPECT_EQ(j["haptic"]["ticks"], 2400);
  EXPECT_EQ(j["haptic"]["overruns"], 3);
  EXPECT_EQ(j["haptic"]["allocations"], 0);
  EXPECT_EQ(j["haptic"]["page_faults"], 0);
  EXPECT_EQ(j["haptic"]["contact_share"], 0.25);
  EXPECT_EQ(j["haptic"]["update_ns"], (json{{"p50", 1000}, {"p99", 2000}, {"p999", 3000}, {"max", 4000}}));
  EXPECT_EQ(j["haptic"]["wakeup_histogram"], (json{{5000, 3}, {8000, 1}}));
  EXPECT_EQ(j["haptic"]["wakeup_ns"], (json{{"p50", 5000}, {"p99", 6000}, {"p999", 7000}, {"max", 8000}}));
  EXPECT_TRUE(j["haptic"]["contact_told_ns"].is_null()) << "a device that pushes in its tick has none";
  EXPECT_EQ(j["haptic"]["memory_bytes"],
            (json{{"task", 600}, {"method", 50}, {"stack", 40}, {"counters", 30}, {"stack_used", 7}}));
  EXPECT_EQ(j["force"], (json{{"max_n", 1.25}, {"max_scene_slew_n_per_s", 49.5}}));
  EXPECT_EQ(j["audio"]["device"], "alsa");
  EXPECT_EQ(j["audio"]["rate_hz"], 48000);
  EXPECT_EQ(j["audio"]["underruns"], 1);
  EXPECT_EQ(j["audio"]["realigned"], 2);
  EXPECT_EQ(j["audio"]["max_offset_ms"], 12.5);
  EXPECT_EQ(j["energy"], (json{{"scene_mj", 2.0}, {"artefact_mj", 0.5}}));
  EXPECT_EQ(j["states"], (json{"boot", "idle", "opening"}));
  EXPECT_EQ(
      j["seeks"][0],
      (json{
          {"target_s", 10.0}, {"picture_s", 10.04}, {"surface_s", 10.04}, {"picture_ms", 45.5}, {"surface_ms", 46.5}}));
  EXPECT_TRUE(j["seeks"][1]["picture_s"].is_null());
  EXPECT_TRUE(j["faults"].is_array());
}

TEST(Report, CountsAFaultThatComesAgainAndAgainInOneEntry) {
  PlayReport r;
  EXPECT_TRUE(r.addFault(1.0, "a", "x"));
  EXPECT_FALSE(r.addFault(2.0, "a", "x"));
  EXPECT_TRUE(r.addFault(3.0, "b", "x"));
  EXPECT_FALSE(r.addFault(4.0, "a", "x"));  // not the last one, but reported before
  const json faults = json::parse(toJson(r))["faults"];
  ASSERT_EQ(faults.size(), 3u);
  EXPECT_EQ(faults[0], (json{{"time_s", 1.0}, {"what", "a"}, {"done", "x"}, {"count", 2}}));
  EXPECT_EQ(faults[2]["time_s"], 4.0);
}

TEST(Report, AFaultOfAnotherNameIsNewAfterMonthsOfOldOnesToo) {
  PlayReport r;
  for (int i = 0; i < 1000; ++i) r.addFault(i, i % 2 == 0 ? "lost" : "back", "x");
  EXPECT_FALSE(r.addFault(1000, "lost", "x"));
  EXPECT_TRUE(r.addFault(1001, "haptic device lost", "x"));
  EXPECT_FALSE(r.addFault(1002, "lost", "x"));
  EXPECT_FALSE(r.addFault(1003, "haptic device lost", "x"));
  EXPECT_EQ(r.faults.size(), 1001u);
}

TEST(Report, IsJsonWhateverItIsGiven) {
  PlayReport r = example();
  r.source = "caf\xe9 \"quoted\".mkv";  // Latin-1, as old file names are
  r.haptic.max_force_n = std::numeric_limits<double>::quiet_NaN();
  r.haptic.scene_mj = std::numeric_limits<double>::infinity();
  const json j = json::parse(toJson(r), nullptr, false);
  ASSERT_FALSE(j.is_discarded());
  EXPECT_EQ(j["force"]["max_n"], 0.0);
}

TEST(Report, TellsPeopleTheSameFigures) {
  PlayReport r = example();
  r.film.has_depth = true;
  const std::string text = toText(r);
  EXPECT_THAT(text, HasSubstr("58 frames shown, 2 dropped"));
  EXPECT_THAT(text, HasSubstr("25 % of the time in contact"));
  EXPECT_THAT(text, HasSubstr("3 of 2403 ticks missed")) << "the 2400 that ran and those between them";
  EXPECT_THAT(text, testing::Not(HasSubstr("p99"))) << "a developer's";
  EXPECT_THAT(toText(r, true), HasSubstr("p99 2.0 us"));
}

TEST(Report, SaysSoWhereNoTimeOfAFilmWasShown) {
  PlayReport r = example();
  EXPECT_THAT(toText(r), HasSubstr("film    2.00 s shown in 2.50 s, first picture after 123 ms"));
  PlayReport chosen = r;
  chosen.states.push_back(PlayerState::Browsing);
  EXPECT_THAT(toText(chosen), HasSubstr("film    2.00 s shown in 2.50 s\n"));
  r.media_s = 0;
  EXPECT_THAT(toText(r), HasSubstr("film    one picture was shown for 2.50 s, after 123 ms"));
  r.frames_shown = 0;
  EXPECT_THAT(toText(r), HasSubstr("film    no picture was shown in 2.50 s"));
}

TEST(Report, AFilmWithoutDepthHasNothingToFeel) {
  PlayReport r = example();
  r.film.has_depth = false;
  r.haptic.plan = "error of the force under 0.1 %";
  EXPECT_THAT(toText(r, true), testing::Not(HasSubstr("0.1 %")));
  EXPECT_THAT(toText(r), HasSubstr("nothing to feel: the film has no depth"));
}

TEST(Recorder, WritesALinePerTickFromTheFirstTicksTimeAndTheDeviceOnce) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "touch.csv";
  auto recorder = Recorder::create(path);
  ASSERT_TRUE(recorder);
  FingerState tick;
  tick.time = MonotonicTime(std::chrono::seconds(100));
  tick.media_time = mediaTime(7.0);
  tick.hip_mm = {1, 2, 1.0 / 3};
  tick.proxy_mm = {1.5, 2.5, 3.5};
  tick.force_n = {0.25, 0, -1e-7};
  tick.device_mm = {0.1, 0.2, 0.1 + 0.2};
  tick.buttons = 5;
  tick.contact = true;
  tick.device_present = true;
  recorder->add(tick);
  recorder->setDevice({"any", {-1, -2, -3}, {4, 5, 6}, 8.5, 1.4, 16.0 / 15, 1000});
  tick.time += std::chrono::milliseconds(3);
  tick.contact = false;
  recorder->add(tick);
  tick = {};
  tick.time = MonotonicTime(std::chrono::nanoseconds(100'004'000'001));
  recorder->add(tick);
  HapticCapabilities mouse{"any", {-1, -2, -3}, {4, 5, 6}, 8, 7, 1, 1000};
  mouse.in_scene = true;
  recorder->setDevice(mouse);
  recorder->add(tick);
  ASSERT_TRUE(recorder->file().commit());

  const std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(),
            "t_s,hip_x_mm,hip_y_mm,hip_z_mm,proxy_x_mm,proxy_y_mm,proxy_z_mm,force_x_n,force_y_n,force_z_n,contact,"
            "media_s,device_x_mm,device_y_mm,device_z_mm,buttons,device_present,workspace_min_x_mm,workspace_min_y_mm,"
            "workspace_min_z_mm,workspace_max_x_mm,workspace_max_y_mm,workspace_max_z_mm,peak_force_n,"
            "continuous_force_n,max_stiffness_n_per_mm,rate_hz\n"
            "0,1,2,0.3333333333333333,1.5,2.5,3.5,0.25,0,-1e-07,1,7,0.1,0.2,0.30000000000000004,5,1,,,,,,,,,,\n"
            "0.003,1,2,0.3333333333333333,1.5,2.5,3.5,0.25,0,-1e-07,0,7,0.1,0.2,0.30000000000000004,5,1,"
            "-1,-2,-3,4,5,6,8.5,1.4,1.0666666666666667,1000\n"
            "0.004000001,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,,,,,,,,,,\n"
            "0.004000001,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,,,,,,,8,7,1,1000\n");
}

}  // namespace
}  // namespace relievo
