// SPDX-License-Identifier: Apache-2.0
// The program as its user runs it: real files, real threads, exit codes, what it prints and what it leaves behind. No
// figure of time is asserted: the machine may be busy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ts_patch.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ClipTrack;
using testing::HasSubstr;
using testing::StartsWith;

ClipTrack color(int frames = 30) {
  return {.pix_fmt = "yuv420p", .width = 64, .height = 48, .frames = frames, .tags = {{"title", "color"}}};
}
ClipTrack depth(int frames = 30) {
  return {.pix_fmt = "gray16le", .width = 64, .height = 48, .frames = frames, .tags = {{"title", "depth"}}};
}

class PlayerProgram : public testing::Test {
 protected:
  // The mock display costs nothing; one test draws.
  test::ProgramResult play(const std::string& words, const std::string& display = "mock") {
    return test::runProgram("relievo play --display " + display + " " + words, at(""));
  }
  [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string textOf(const std::string& name) const {
    const std::ifstream file(at(name));
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  [[nodiscard]] json reportOf(const std::string& name) const { return json::parse(textOf(name), nullptr, false); }
  // Nothing is left but what the test itself put there and what the program said.
  void expectNothingLeft(const std::vector<std::string>& put) const {
    for (const auto& entry : fs::directory_iterator(at(""))) {
      const std::string name = entry.path().filename();
      if (name == "stdout.txt" || name == "stderr.txt") continue;
      EXPECT_NE(std::find(put.begin(), put.end(), name), put.end()) << name;
    }
  }
  static void expectOneLine(const test::ProgramResult& result, int exit_code, const std::string& thing) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_THAT(result.err, StartsWith("relievo: "));
    EXPECT_THAT(result.err, HasSubstr(thing));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
  }

  // Without an end, with both files to write.
  [[nodiscard]] std::vector<std::string> endless(const std::string& film) const {
    return {std::string(RELIEVO_BIN_DIR) + "/relievo",
            "play",
            at(film),
            "--loop",
            "--display",
            "mock",
            "--report",
            at("r.json"),
            "--record",
            at("t.csv")};
  }

  test::TemporaryFolder folder_;
};

TEST_F(PlayerProgram, SelftestPassesWithoutAnyHardware) {
  const auto said = test::runProgram("relievo selftest", at(""));
  EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
  EXPECT_THAT(said.out, HasSubstr("good  display   offscreen, 640x360"));
  EXPECT_THAT(said.out, HasSubstr("good  touch     sim"));
}

TEST_F(PlayerProgram, PlaysAClipThroughTheWholeStackAndReportsIt) {
  test::makeClip(at("film.mkv"), {color(), depth()});
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
  test::makeClip(at("film.mkv"), {color(60), depth(60)}, {},
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
  test::makeClip(at("film.mkv"), {color(), depth()}, {}, {{}});
  const auto result = play(at("film.mkv") + " --audio alsa:nothing --report " + at("r.json"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no such sound card"));
  EXPECT_EQ(reportOf("r.json")["faults"].size(), 1u);
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
  test::makeClip(at("c.mkv"), {odd_color});
  test::makeClip(at("d.mkv"), {odd_depth});
  const auto result = play(at("c.mkv") + " --depth " + at("d.mkv") + " --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json r = reportOf("r.json");
  EXPECT_EQ(r["video"]["frames_shown"].get<int>() + r["video"]["frames_dropped"].get<int>(), 30);
  EXPECT_EQ(r["states"].back(), "idle");
}

TEST_F(PlayerProgram, TellsTheDepthOfABroadcastByItsStreamType) {
  ClipTrack plain = color();
  plain.codec = "libx264";
  plain.tags.clear();
  test::makeClip(at("film.ts"), {plain, plain});
  ASSERT_GT(test::signalAsDepth(at("film.ts"), 0), 0);
  const auto text = test::runProgram("relievo probe " + at("film.ts"), at(""));
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("0 video h264 64 x 48, signalled as depth by its stream type, "));
  const auto result = test::runProgram("relievo probe --json " + at("film.ts"), at(""));
  const json r = json::parse(result.out, nullptr, false);
  ASSERT_FALSE(r.is_discarded());
  EXPECT_EQ(r["tracks"][0]["auxiliary"], true);
  EXPECT_EQ(r["tracks"][1]["auxiliary"], false);
  EXPECT_TRUE(r["depth"].is_object());
}

TEST_F(PlayerProgram, RefusesAnAddressThatReadsWhatItIsNotToReadInOneLine) {
  expectOneLine(play("'concat:" + at("a.ts") + "|" + at("b.ts") + "'"), 1, "concat:");
}

TEST_F(PlayerProgram, ObeysAScriptedRemote) {
  test::makeClip(at("film.mkv"), {color(600), depth(600)});
  std::ofstream(at("keys.txt")) << "1.0 FORWARD\n1.3 PAUSE\n1.6 REWIND\n1.9 PLAY\n2.0 3D_MODE\n2.3 STOP\n";
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
  test::makeClip(at("film.mkv"), {color(), depth()});
  fs::resize_file(at("film.mkv"), fs::file_size(at("film.mkv")) / 2);
  const auto result = play(at("film.mkv") + " --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json r = reportOf("r.json");
  const int seen = r["video"]["frames_shown"].get<int>() + r["video"]["frames_dropped"].get<int>();
  EXPECT_GT(seen, 5);
  EXPECT_LT(seen, 25);
  EXPECT_THAT(result.err, HasSubstr("film.mkv ends 0."));
  EXPECT_THAT(result.err, HasSubstr("the part that exists was played"));
  bool told = false;
  for (const json& fault : r["faults"]) {
    told = told || fault["what"].get<std::string>().find("too early") != std::string::npos;
  }
  EXPECT_TRUE(told) << r["faults"];
}

TEST_F(PlayerProgram, WithoutDepthItSaysSoOnceAndPlays) {
  test::makeClip(at("film.mkv"), {color(10)});
  const auto result = play(at("film.mkv") + " --report " + at("r.json"));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("no depth"));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_EQ(reportOf("r.json")["force"]["max_n"], 0.0);
}

TEST_F(PlayerProgram, SaysInOneLineWhatIsWrongWithASource) {
  expectOneLine(play(at("missing.mkv")), 1, "missing.mkv");
  std::ofstream(at("text.mkv")) << "Not a film at all, but a few words of text.\n";
  expectOneLine(play(at("text.mkv")), 1, "text.mkv");
  std::ofstream(at("empty.mkv")).flush();
  expectOneLine(play(at("empty.mkv")), 1, "empty.mkv");
  fs::create_directory(at("none"));
  expectOneLine(play(at("none")), 1, at("none"));
  test::makeClip(at("film.mkv"), {color(3), depth(3)});
  expectOneLine(play(at("film.mkv") + " --depth " + at("missing.mkv")), 1, "missing.mkv");
  expectOneLine(play(at("film.mkv") + " --depth " + at("text.mkv")), 1, "text.mkv");
  expectOneLine(test::runProgram("relievo probe " + at("text.mkv"), at("")), 1, "text.mkv");
}

TEST_F(PlayerProgram, AFailureIsInTheReportAndLeavesNothingHalfDone) {
  const auto result = play(at("missing.mkv") + " --report " + at("r.json") + " --record " + at("t.csv"));
  expectOneLine(result, 1, "missing.mkv");
  const json r = reportOf("r.json");
  EXPECT_EQ(r["states"], (json{"boot", "idle", "opening", "fault"}));
  EXPECT_EQ(r["faults"].size(), 1u);
  expectNothingLeft({"r.json"});
}

TEST_F(PlayerProgram, WhatCannotBeWrittenIsFoundOutBeforePlaying) {
  test::makeClip(at("film.mkv"), {color(3), depth(3)});
  const auto report = play(at("film.mkv") + " --report " + at("missing/r.json") + " --record " + at("t.csv"));
  expectOneLine(report, 1, "missing/r.json");
  const auto record = play(at("film.mkv") + " --report " + at("r.json") + " --record " + at("missing/t.csv"));
  expectOneLine(record, 1, "missing/t.csv");
  const auto capture = play(at("film.mkv"), "offscreen:" + at("missing/x.y4m"));
  EXPECT_EQ(capture.exit_code, 1) << capture.err;
  EXPECT_THAT(capture.err, HasSubstr("the capture file cannot be written"));
  expectNothingLeft({"film.mkv"});
}

// An @ that no rate follows is part of the file's name, for the guard as for the display.
TEST_F(PlayerProgram, ACaptureOntoTheFilmIsRefusedWhateverItsName) {
  for (const char* film : {"a@b.mkv", "film.mkv"}) {
    test::makeClip(at(film), {color(3), depth(3)});
    for (const char* rate : {"", "@25"}) {
      const auto result = play(at(film), "offscreen:" + at(film) + rate);
      expectOneLine(result, 2, "would be overwritten");
    }
    EXPECT_EQ(test::runProgram("relievo probe " + at(film), at("")).exit_code, 0) << "the film is still one";
  }
}

TEST_F(PlayerProgram, WrongUseIsCodeTwoAndOneLine) {
  expectOneLine(play("film.mkv --spin"), 2, "--spin");
  expectOneLine(play(""), 2, "SOURCE");
  expectOneLine(play("film.mkv", "hologram"), 2, "hologram");
  expectOneLine(play("film.mkv --haptic glove"), 2, "glove");
  expectOneLine(play("film.mkv --remote mind"), 2, "mind");
  expectOneLine(play("film.mkv --calibration near=-5"), 2, "near=-5");
  expectOneLine(play("film.mkv --haptic none --record " + at("t.csv")), 2, "--record");
  expectOneLine(play("film.mkv --depth-strength nan"), 2, "--depth-strength: nan");
  expectOneLine(play("film.mkv --depth-strength 2.1"), 2, "--depth-strength: 2.1");
  expectOneLine(play("film.mkv --rate 9000"), 2, "--rate: 9000 is not between 500 and 8000");
  expectOneLine(play("film.mkv --rate 499"), 2, "--rate: 499 is not between 500 and 8000");
  expectOneLine(play("film.mkv --haptic replay:" + at("t.csv") + " --record " + at("t.csv")), 2,
                "would be overwritten");
  expectOneLine(play("film.mkv --haptic sim:tense," + at("t.csv") + " --record " + at("t.csv")), 2,
                "would be overwritten");
  expectOneLine(play("film.mkv " + at("next.mkv") + " --report " + at("next.mkv")), 2, "would be overwritten");
  expectNothingLeft({});
}

TEST_F(PlayerProgram, ADeviceThatCannotTickAsOftenIsToldOfInOneLineAndPlays) {
  test::makeClip(at("film.mkv"), {color(10), depth(10)});
  const std::string words = at("film.mkv") + " --report " + at("r.json") + " --haptic ";
  const auto fast = play(words + "sim --rate 2000");
  EXPECT_EQ(fast.exit_code, 0) << fast.err;
  EXPECT_THAT(fast.err, testing::Not(HasSubstr("--rate")));
  EXPECT_EQ(reportOf("r.json")["haptic"]["rate_hz"], 2000);
  const auto slow = play(words + "sim:falcon --rate 2000");
  EXPECT_EQ(slow.exit_code, 0) << slow.err;
  EXPECT_THAT(slow.err, HasSubstr("sim falcon runs at 1000 Hz, its best; it cannot have the 2000 of --rate\n"));
  EXPECT_EQ(reportOf("r.json")["haptic"]["rate_hz"], 1000);
}

// Some words can be judged only beside the film.
TEST_F(PlayerProgram, ACalibrationThatDoesNotFitTheFilmIsWrongUse) {
  ClipTrack bytes = depth(3);
  bytes.pix_fmt = "gray";
  test::makeClip(at("film.mkv"), {color(3), bytes});
  for (const char* words : {"invalid=300", "bits=12", "near=6000"}) {
    expectOneLine(play(at("film.mkv") + " --calibration " + words), 2, "calibration");
    const auto probed = test::runProgram("relievo probe " + at("film.mkv") + " --calibration " + words, at(""));
    EXPECT_EQ(probed.exit_code, 2) << probed.err;
  }
  std::ofstream(at("camera.txt")) << "near = 6000\n";
  expectOneLine(play(at("film.mkv") + " --calibration " + at("camera.txt")), 1, "calibration");
}

// The simulated hand has no eyes: it is told where there is something.
TEST_F(PlayerProgram, TheSimulatedHandFindsWhatThereIsBesideAHole) {
  ClipTrack ring = depth(75);
  ring.pix_fmt = "gray";
  ring.sample = [](int, int c, int r, int) { return std::hypot(c - 32, r - 24) < 14 ? 0u : 128u; };
  test::makeClip(at("film.mkv"), {color(75), ring});
  const auto result = play(at("film.mkv") + " --calibration invalid=0 --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(reportOf("r.json")["haptic"]["contact_share"].get<double>(), 0.0);
}

TEST_F(PlayerProgram, AScriptThatIsMissingOrWrongIsOneLine) {
  std::ofstream(at("keys.txt")) << "1 PLAY\n2 PLAZ\n";
  std::ofstream(at("hand.csv")) << "t_s,x_mm,y_mm,z_mm\n0,1,2\n";
  expectOneLine(play("film.mkv --remote script:" + at("none.txt")), 1, "none.txt: ");
  expectOneLine(play("film.mkv --remote script:" + at("keys.txt")), 2, "keys.txt:2: ");
  expectOneLine(play("film.mkv --haptic sim:" + at("none.csv")), 1, "none.csv: ");
  expectOneLine(play("film.mkv --haptic sim:" + at("hand.csv")), 2, "hand.csv:2: ");
}

TEST_F(PlayerProgram, KindsOfRecordingsAreListedAndStated) {
  const auto listed = test::runProgram("relievo play --as help", at(""));
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  for (const char* kind : {"\ntum ", "\nkitti ", "\nrecord3d ", "\nsun "}) EXPECT_THAT(listed.out, HasSubstr(kind));
  expectOneLine(test::runProgram("relievo probe --as nothing film.mkv", at("")), 2, "unknown kind; see --as help");
  expectOneLine(test::runProgram("relievo probe --calibration unit=1,polarity=near-high film.mkv", at("")), 2,
                "polarity=near-high; leave one out");

  ClipTrack slope = depth(3);
  slope.sample = [](int, int c, int, int) { return 5000u + 100u * static_cast<unsigned>(c); };
  test::makeClip(at("film.mkv"), {color(3), slope});
  const auto stated = test::runProgram("relievo probe --as tum " + at("film.mkv"), at(""));
  EXPECT_EQ(stated.exit_code, 0) << stated.err;
  EXPECT_THAT(stated.out, HasSubstr("reading depth distances, 5000 codes a metre, 0.90 to 2.49 m"));
  EXPECT_THAT(stated.out, HasSubstr("unit=0.2: --as, said"));
}

TEST_F(PlayerProgram, ProbeTellsTheFilmAndTheDepthOfAFolder) {
  std::filesystem::create_directory(at("take"));
  ClipTrack pictures = depth(3);
  pictures.codec = "png";
  pictures.pix_fmt = "gray16be";
  test::makeClip(at("take/color.mkv"), {color(3)});
  test::makeClip(at("take/depth-%d.png"), {pictures});
  const auto told = test::runProgram("relievo probe " + at("take"), at(""));
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("track   " + at("take/color.mkv") + " 0 video"));
  EXPECT_THAT(told.out, HasSubstr("track   " + at("take/depth-*.png") + " 0 video png"));
}

TEST_F(PlayerProgram, ProbeTellsWhatIsInASource) {
  ClipTrack plane = depth(5);
  plane.sample = [](int, int c, int, int) { return c < 32 ? 1000u : 65000u; };
  plane.tags["DEPTH_LAW"] = "inverse";
  test::makeClip(at("film.mkv"), {color(5), plane});
  const auto text = test::runProgram("relievo probe " + at("film.mkv"), at(""));
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("law=inverse: container tags, said"));
  EXPECT_THAT(text.out, HasSubstr("codes 1000 to 65000"));
  const auto as_json = test::runProgram("relievo probe --json " + at("film.mkv"), at(""));
  const json j = json::parse(as_json.out, nullptr, false);
  ASSERT_FALSE(j.is_discarded());
  EXPECT_EQ(j["tracks"].size(), 2u);
  EXPECT_EQ(j["packing"], "tracks");
  EXPECT_EQ(j["depth"]["codes"], (json{1000, 65000}));
  EXPECT_EQ(j["color"]["width"], 64);

  // The tracks are listed whatever is wrong with the film in them.
  const auto refused = test::runProgram("relievo probe --calibration bits=8,near=9000 " + at("film.mkv"), at(""));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.out, HasSubstr("0 video ffv1 64 x 48, yuv420p of 8 bits, 30 frames a second \"color\""));
  EXPECT_THAT(refused.out, HasSubstr("1 video ffv1 64 x 48, gray16le of 16 bits, 30 frames a second \"depth\""));
  EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;

  test::makeClip(at("flat.mkv"), {color(5)});
  EXPECT_THAT(test::runProgram("relievo probe " + at("flat.mkv"), at("")).out, HasSubstr("give --depth"));
}

// Ctrl-C in the middle of an endless film: code 0 and a whole report.
TEST_F(PlayerProgram, ASignalEndsTheFilmInGoodOrder) {
  test::makeClip(at("film.mkv"), {color(), depth()});
  test::Process player(endless("film.mkv"), at("said.txt"));
  while (!player.catches(SIGINT) && player.isRunning()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  player.send(SIGINT);
  EXPECT_EQ(player.wait(), 0);
  EXPECT_EQ(reportOf("r.json")["states"].back(), "idle");
}

TEST_F(PlayerProgram, ASecondSignalEndsItAtOnceAndLeavesNothing) {
  test::makeClip(at("film.mkv"), {color(), depth()});
  for (const int second : {SIGINT, SIGHUP}) {
    test::Process player(endless("film.mkv"), at("said.txt"));
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
      play(cup + "color_output.webm --depth " + cup + "depth_output.webm --duration 1.5 --report " + at("r.json"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json r = reportOf("r.json");
  EXPECT_EQ(r["video"]["pairs_mismatched"], 0);
  EXPECT_EQ(r["film"]["depth"]["width"], 288);
  EXPECT_NEAR(r["film"]["volume_mm"][1].get<double>(), 160.0 * 512 / 288, 0.01);
}

// Killed in the middle, it goes on where the film was, to within what is shown between two notes of the place.
TEST_F(PlayerProgram, AfterAKillItGoesOnWhereItWas) {
  test::makeClip(at("film.mkv"), {color(900), depth(900)});
  ::setenv("XDG_STATE_HOME", at("state").c_str(), 1);
  const auto kept = [this] {
    const json films = json::parse(textOf("state/relievo/resume.json"), nullptr, false);
    return films.is_array() && !films.empty() ? films[0][1].get<double>() : 0.0;
  };
  double left_s = 0;
  {
    test::Process player({std::string(RELIEVO_BIN_DIR) + "/relievo", "play", at("film.mkv"), "--display", "mock",
                          "--resume", "--record", at("t.csv")},
                         at("stderr.txt"));
    for (int i = 0; i < 600 && kept() < 3; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    player.send(SIGKILL);
    EXPECT_EQ(player.wait(), -SIGKILL);
    left_s = kept();
  }
  ASSERT_GE(left_s, 3);
  EXPECT_FALSE(fs::exists(at("t.csv"))) << "half written";
  const auto again = play(at("film.mkv") + " --resume --duration 2 --report " + at("r.json"));
  EXPECT_EQ(again.exit_code, 0) << again.err;
  const double shown_s = reportOf("r.json")["media_s"].get<double>();
  EXPECT_NEAR(kept(), left_s + shown_s, 0.1);
  ::unsetenv("XDG_STATE_HOME");
}

// A still relief, another one from the third picture on, and from the fifth on it rises fast: the plan is that of the
// first four pictures, in which nothing moves but at the cut.
TEST_F(PlayerProgram, ProbeAnnouncesThePlanOfThePlayer) {
  ClipTrack moving = depth();
  moving.sample = [](int, int c, int r, int k) {
    const int wave = k < 2 ? 900 * c : 900 * (63 - c);
    return static_cast<std::uint32_t>(wave + 40 * r + 500 * std::max(k - 3, 0));
  };
  test::makeClip(at("film.mkv"), {color(), moving});
  const auto probed = test::runProgram("relievo probe --json " + at("film.mkv"), at(""));
  ASSERT_EQ(probed.exit_code, 0) << probed.err;
  const json said = json::parse(probed.out);
  ASSERT_EQ(play(at("film.mkv") + " --report " + at("r.json")).exit_code, 0);
  EXPECT_EQ(said["touch"]["reason"], reportOf("r.json")["haptic"]["plan"]);
  EXPECT_EQ(said["touch"]["speed_mm_per_s"], 0) << "a cut is no motion";
}

TEST_F(PlayerProgram, WhatWasAskedForAndDidNotHappenIsAFailure) {
  const auto silent = play("udp://127.0.0.1:47391 --duration 1");
  EXPECT_EQ(silent.exit_code, 1);
  EXPECT_THAT(silent.err, HasSubstr("udp://127.0.0.1:47391: --duration ended before the first picture came"));
  test::makeClip(at("film.mkv"), {color(), depth()});
  ::setenv("XDG_STATE_HOME", at("film.mkv").c_str(), 1);  // a file, where a folder is to be
  expectOneLine(play(at("film.mkv") + " --resume"), 1, "--resume " + at("film.mkv"));
  ::unsetenv("XDG_STATE_HOME");
}

TEST_F(PlayerProgram, AListIsPlayedFilmByFilm) {
  test::makeClip(at("one.mkv"), {color(), depth()});
  test::makeClip(at("two.mkv"), {color(15), depth(15)});
  std::ofstream(at("list.m3u")) << "#EXTM3U\n#EXTINF:1,One\none.mkv\nnone.mkv\ntwo.mkv\n";
  const auto result = play(at("list.m3u") + " --report " + at("r.json"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("none.mkv"));
  const json r = reportOf("r.json");
  EXPECT_EQ(r["films"], (json{at("one.mkv"), at("none.mkv"), at("two.mkv")}));
  EXPECT_EQ(r["video"]["frames_shown"].get<int>() + r["video"]["frames_dropped"].get<int>(), 45);
}

TEST_F(PlayerProgram, AWrongKeyTableIsNamedByItsLine) {
  std::ofstream(at("keys.toml")) << "[always]\nRIGHT = \"dance\"\n";
  expectOneLine(play("film.mkv --keys " + at("keys.toml")), 2, "keys.toml:2");
}

}  // namespace
}  // namespace relievo
