// SPDX-License-Identifier: Apache-2.0
// The program plays: real files, real threads, what is in the report. No figure of time is asserted: the machine may be
// busy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/scenario/program/player_program.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(PlayerProgram, SelftestPassesWithoutAnyHardware) {
  const auto said = runProgram("relievo selftest", at(""));
  EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
  EXPECT_THAT(said.out, HasSubstr("good  display   offscreen, 640x360"));
  EXPECT_THAT(said.out, HasSubstr("good  touch     sim"));
}

TEST_F(PlayerProgram, PlaysAClipThroughTheWholeStackAndReportsIt) {
  makeClip(at("film.mkv"), {color(), depth()});
  const auto result =
      play(at("film.mkv") + " --size 320x180 --report " + at("r.json") + " --record " + at("t.csv"), "offscreen");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("frames shown"));
  const json r = reportOf("r.json");
  ASSERT_FALSE(r.is_discarded());
  EXPECT_EQ(r["video"]["frames_shown"].get<int>() + r["video"]["frames_dropped"].get<int>(), 30);
  EXPECT_GT(r["video"]["frames_shown"].get<int>(), 0);
  EXPECT_EQ(r["video"]["pairs_mismatched"], 0);
  EXPECT_TRUE(r["video"]["first_frame_ms"].is_number());
  EXPECT_EQ(r["video"]["surface"], (json{320, 180}));
  EXPECT_GT(r["video"]["triangles"].get<int>(), 1);
  EXPECT_EQ(r["film"]["packing"], "tracks");
  EXPECT_THAT(r["film"]["calibration"].get<std::string>(), HasSubstr("bits=16"));
  EXPECT_THAT(r["states"].dump(), StartsWith(R"(["boot","idle","opening","buffering","playing",)"));
  EXPECT_THAT(r["states"].dump(), testing::EndsWith(R"("playing","ended","idle"])"));
  EXPECT_GT(r["haptic"]["ticks"].get<int>(), 0);
  EXPECT_GT(r["haptic"]["update_ns"]["p50"].get<int>(), 0);
  EXPECT_GE(r["haptic"]["wakeup_ns"]["max"].get<int>(), r["haptic"]["wakeup_ns"]["p50"].get<int>());
  for (const char* field : {"overruns", "allocations", "page_faults"})
    EXPECT_TRUE(r["haptic"][field].is_number()) << field;
  const json& memory = r["haptic"]["memory_bytes"];
  for (const char* part : {"task", "method", "stack", "counters"}) EXPECT_GT(memory[part], 0) << part;
  EXPECT_LT(memory["stack_used"], memory["stack"]);
  EXPECT_GT(memory["stack_used"], 0);
  for (const char* field : {"max_n", "max_scene_slew_n_per_s"}) EXPECT_TRUE(r["force"][field].is_number()) << field;
  for (const char* field : {"scene_mj", "artefact_mj"}) EXPECT_TRUE(r["energy"][field].is_number()) << field;

  const std::string csv = textOf("t.csv");
  const auto lines = std::count(csv.begin(), csv.end(), '\n');
  EXPECT_EQ(lines - 1, r["haptic"]["ticks"].get<int>());  // every tick, and the header
}

TEST_F(PlayerProgram, PlaysTheSoundThatIsInTheClip) {
  makeClip(at("film.mkv"), {color(60), depth(60)}, {},
           {{.codec = "aac", .rate_hz = 44100, .length = std::chrono::seconds(2)}});
  const auto result = play(at("film.mkv") + " --audio null --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json r = reportOf("r.json");
  EXPECT_EQ(r["audio"]["device"], "null");
  EXPECT_EQ(r["audio"]["codec"], "aac");
  EXPECT_EQ(r["audio"]["rate_hz"], 48000);
  EXPECT_GT(r["audio"]["pictures"].get<int>(), 0);
  EXPECT_EQ(r["states"].back(), "idle");
  expectOneLine(play(at("film.mkv") + " --audio pulse"), 2, "pulse");
}

TEST_F(PlayerProgram, PlaysWithoutASoundCardAndSaysSoOnce) {
  makeClip(at("film.mkv"), {color(), depth()}, {}, {{}});
  const auto result = play(at("film.mkv") + " --audio alsa:nothing --report " + at("r.json"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no such sound card"));
  const json faults = reportOf("r.json")["faults"];  // a busy machine has others, such as late ticks
  const auto of_sound = [](const json& fault) { return fault["what"].get<std::string>().starts_with("sound"); };
  EXPECT_EQ(std::count_if(faults.begin(), faults.end(), of_sound), 1);
}

TEST_F(PlayerProgram, PlaysColorAndDepthOfDifferentLengthRateAndOddSizes) {
  ClipTrack odd_color = color(30);
  odd_color.pix_fmt = "yuv444p";
  odd_color.width = 63;
  odd_color.height = 47;
  ClipTrack odd_depth = depth(8);  // 0.8 s at 10 a second, the colour lasts 1 s
  odd_depth.fps_num = 10;
  odd_depth.width = 31;
  odd_depth.height = 29;
  makeClip(at("c.mkv"), {odd_color});
  makeClip(at("d.mkv"), {odd_depth});
  const auto result = play(at("c.mkv") + " --depth " + at("d.mkv") + " --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json r = reportOf("r.json");
  EXPECT_EQ(r["video"]["frames_shown"].get<int>() + r["video"]["frames_dropped"].get<int>(), 30);
  EXPECT_EQ(r["states"].back(), "idle");
}

TEST_F(PlayerProgram, ObeysAScriptedRemote) {
  makeClip(at("film.mkv"), {color(600), depth(600)});
  std::ofstream(at("keys.txt")) << "4.0 FORWARD\n4.3 PAUSE\n4.6 REWIND\n4.9 PLAY\n5.0 3D_MODE\n5.3 STOP\n";
  const auto result = play(at("film.mkv") + " --remote script:" + at("keys.txt") + " --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json r = reportOf("r.json");
  EXPECT_EQ(r["states"].back(), "idle");
  EXPECT_EQ(r["video"]["stereo"], "sbs");
  ASSERT_EQ(r["seeks"].size(), 2u);
  for (const json& seek : r["seeks"]) {
    EXPECT_TRUE(seek["picture_s"].is_null() || seek["picture_s"] == seek["surface_s"]) << seek;
  }
}

TEST_F(PlayerProgram, AFileCutInTheMiddlePlaysWhatIsThere) {
  makeClip(at("film.mkv"), {color(), depth()});
  fs::resize_file(at("film.mkv"), fs::file_size(at("film.mkv")) / 2);
  const auto result = play(at("film.mkv") + " --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 1) << result.err;
  const json r = reportOf("r.json");
  const int seen = r["video"]["frames_shown"].get<int>() + r["video"]["frames_dropped"].get<int>();
  EXPECT_GT(seen, 5);
  EXPECT_LT(seen, 25);
  EXPECT_THAT(result.err, HasSubstr("film.mkv lacks at least 0."));
  EXPECT_THAT(result.err, HasSubstr("the part that exists was played"));
  EXPECT_THAT(result.err, HasSubstr(at("film.mkv") + ": it is not whole"));
  EXPECT_THAT(result.out, HasSubstr("frames"));
  bool told = false;
  for (const json& fault : r["faults"]) {
    told = told || fault["what"].get<std::string>().find("lacks") != std::string::npos;
  }
  EXPECT_TRUE(told) << r["faults"];
}

TEST_F(PlayerProgram, WithoutDepthItSaysSoOnceAndPlays) {
  makeClip(at("film.mkv"), {color(10)});
  const auto result = play(at("film.mkv") + " --report " + at("r.json"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("no depth"));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_EQ(reportOf("r.json")["force"]["max_n"], 0.0);
}

TEST_F(PlayerProgram, ADeviceThatCannotTickAsOftenIsToldOfInOneLineAndPlays) {
  makeClip(at("film.mkv"), {color(10), depth(10)});
  const std::string words = at("film.mkv") + " --report " + at("r.json") + " --haptic ";
  const auto fast = play(words + "sim --rate 2000");
  EXPECT_EQ(fast.exit_code, 0) << fast.err;
  EXPECT_THAT(fast.err, testing::Not(HasSubstr("--rate")));
  EXPECT_EQ(reportOf("r.json")["haptic"]["rate_hz"], 2000);
  const auto slow = play(words + "sim:falcon --rate 2000");
  EXPECT_EQ(slow.exit_code, 0) << slow.err;
  EXPECT_THAT(slow.err,
              HasSubstr("sim falcon runs at 1000 Hz, its highest rate; it cannot run at the 2000 Hz of --rate\n"));
  EXPECT_EQ(reportOf("r.json")["haptic"]["rate_hz"], 1000);
}

// The simulated hand has no eyes: the player tells it where there is something to touch.
TEST_F(PlayerProgram, TheSimulatedHandFindsWhatThereIsBesideAHole) {
  ClipTrack ring = depth(75);
  ring.pix_fmt = "gray";
  ring.sample = [](int, int c, int r, int) { return std::hypot(c - 32, r - 24) < 14 ? 0u : 128u; };
  makeClip(at("film.mkv"), {color(75), ring});
  const auto result = play(at("film.mkv") + " --calibration invalid=0 --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(reportOf("r.json")["haptic"]["contact_share"].get<double>(), 0.0);
}

// Ctrl-C in the middle of an endless film: code 0 and a whole report.
TEST_F(PlayerProgram, ASignalEndsTheFilmInGoodOrder) {
  makeClip(at("film.mkv"), {color(), depth()});
  Process player(endless("film.mkv"), at("said.txt"));
  while (!player.catches(SIGINT) && player.isRunning()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  player.send(SIGINT);
  EXPECT_EQ(player.wait(), 0);
  EXPECT_EQ(reportOf("r.json")["states"].back(), "idle");
}

TEST_F(PlayerProgram, ASecondSignalEndsItAtOnceAndLeavesNothing) {
  makeClip(at("film.mkv"), {color(), depth()});
  for (const int second : {SIGINT, SIGHUP}) {
    Process player(endless("film.mkv"), at("said.txt"));
    while (!player.catches(SIGHUP) && player.isRunning()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    player.sendBoth(SIGTERM, second);
    EXPECT_LT(player.wait(), 0) << "ended by a signal";
    expectNothingLeft({"film.mkv", "said.txt"});
  }
}

TEST_F(PlayerProgram, PlaysRealFootage) {
  const std::string cup = std::string(RELIEVO_TEST_DATA) + "/cup/";
  if (!fs::exists(cup + "color_output.webm")) GTEST_SKIP() << "no real footage at " << cup;
  const auto result =
      play(cup + "color_output.webm --depth " + cup + "depth_output.webm --duration 5 --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json r = reportOf("r.json");
  EXPECT_EQ(r["video"]["pairs_mismatched"], 0);
  EXPECT_EQ(r["film"]["depth"]["width"], 288);
  EXPECT_NEAR(r["film"]["volume_mm"][1].get<double>(), 160.0 * 512 / 288, 0.01);
}

// Killed in the middle, it goes on where the film was, to within what is shown between two notes of the place.
TEST_F(PlayerProgram, AfterAKillItGoesOnWhereItWas) {
  makeClip(at("film.mkv"), {color(900), depth(900)});
  ::setenv("XDG_STATE_HOME", at("state").c_str(), 1);
  const auto kept = [this] {
    const json films = json::parse(textOf("state/relievo/resume.json"), nullptr, false);
    return films.is_array() && !films.empty() ? films[0][1].get<double>() : 0.0;
  };
  double left_s = 0;
  {
    Process player({std::string(RELIEVO_BIN_DIR) + "/relievo", "play", at("film.mkv"), "--display", "mock", "--resume",
                    "--record", at("t.csv")},
                   at("stderr.txt"));
    for (int i = 0; i < 600 && kept() < 3; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    player.send(SIGKILL);
    EXPECT_EQ(player.wait(), -SIGKILL);
    left_s = kept();
  }
  ASSERT_GE(left_s, 3);
  EXPECT_FALSE(fs::exists(at("t.csv"))) << "half written";
  const auto again = play(at("film.mkv") + " --resume --duration 5 --report " + at("r.json"));
  EXPECT_EQ(again.exit_code, 0) << again.err;
  const double shown_s = reportOf("r.json")["media_s"].get<double>();
  EXPECT_NEAR(kept(), left_s + shown_s, 0.5);  // from the beginning it would be 3 s and more
  ::unsetenv("XDG_STATE_HOME");
}

TEST_F(PlayerProgram, AFilmMayBeGivenByItsFileUrl) {
  makeClip(at("two words.mkv"), {color(), depth()});
  const auto result = play("file://" + at("two%20words.mkv") + " --report " + at("r.json"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(reportOf("r.json")["source"], at("two words.mkv"));
}

TEST_F(PlayerProgram, AListIsPlayedFilmByFilm) {
  makeClip(at("one.mkv"), {color(), depth()});
  makeClip(at("two.mkv"), {color(15), depth(15)});
  std::ofstream(at("list.m3u")) << "#EXTM3U\n#EXTINF:1,One\none.mkv\nnone.mkv\ntwo.mkv\n";
  const auto result = play(at("list.m3u") + " --report " + at("r.json"));
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("\nrelievo: " + at("none.mkv"))) << "the last line";
  const json r = reportOf("r.json");
  EXPECT_EQ(r["films"], (json{at("one.mkv"), at("none.mkv"), at("two.mkv")}));
  EXPECT_EQ(r["video"]["frames_shown"].get<int>() + r["video"]["frames_dropped"].get<int>(), 45);
}

}  // namespace
}  // namespace relievo::test
