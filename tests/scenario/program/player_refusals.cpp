// SPDX-License-Identifier: Apache-2.0
// What the program refuses or cannot do, in one line and with its exit code.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "platform/unique_fd.h"
#include "tests/scenario/program/player_program.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"

namespace relievo::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

TEST_F(PlayerProgram, RefusesAnAddressThatReadsWhatItIsNotToReadInOneLine) {
  expectOneLine(play("'concat:" + at("a.ts") + "|" + at("b.ts") + "'"), 1, "concat:");
}

TEST_F(PlayerProgram, SaysInOneLineWhatIsWrongWithASource) {
  expectOneLine(play(at("missing.mkv")), 1, "missing.mkv");
  std::ofstream(at("text.mkv")) << "Not a film at all, but a few words of text.\n";
  expectOneLine(play(at("text.mkv")), 1, "text.mkv");
  std::ofstream(at("empty.mkv")).flush();
  expectOneLine(play(at("empty.mkv")), 1, "empty.mkv");
  fs::create_directory(at("none"));
  expectOneLine(play(at("none")), 1, at("none"));
  makeClip(at("film.mkv"), {color(3), depth(3)});
  expectOneLine(play(at("film.mkv") + " --depth " + at("missing.mkv")), 1, "missing.mkv");
  expectOneLine(play(at("film.mkv") + " --depth " + at("text.mkv")), 1, "text.mkv");
  expectOneLine(runProgram("relievo probe " + at("text.mkv"), at("")), 1, "text.mkv");
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
  makeClip(at("film.mkv"), {color(3), depth(3)});
  const auto report = play(at("film.mkv") + " --report " + at("missing/r.json") + " --record " + at("t.csv"));
  expectOneLine(report, 1, "missing/r.json");
  const auto record = play(at("film.mkv") + " --report " + at("r.json") + " --record " + at("missing/t.csv"));
  expectOneLine(record, 1, "missing/t.csv");
  const auto capture = play(at("film.mkv"), "offscreen:" + at("missing/x.y4m"));
  EXPECT_EQ(capture.exit_code, 1) << capture.err;
  EXPECT_THAT(capture.err, HasSubstr("the capture file cannot be written"));
  ASSERT_EQ(::mkfifo(at("pipe.y4m").c_str(), 0600), 0);
  const auto piped = play(at("film.mkv"), "offscreen:" + at("pipe.y4m"));
  EXPECT_EQ(piped.exit_code, 1) << piped.err;
  EXPECT_THAT(piped.err, HasSubstr("no program reads this pipe; start its reader first"));
  expectNothingLeft({"film.mkv", "pipe.y4m"});
}

// As where a shell starts both of them.
TEST_F(PlayerProgram, TheReaderOfACaptureMayOpenItsPipeALittleLater) {
  makeClip(at("film.mkv"), {color(3), depth(3)});
  ASSERT_EQ(::mkfifo(at("pipe.y4m").c_str(), 0600), 0);
  Process player({RELIEVO_BIN_DIR "/relievo", "play", at("film.mkv"), "--display", "offscreen:" + at("pipe.y4m")},
                 at("said.txt"));
  while (!player.catches(SIGTERM) && player.isRunning()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // by then it waits for the reader
  const UniqueFd pipe(::open(at("pipe.y4m").c_str(), O_RDONLY | O_NONBLOCK));
  pollfd wait{.fd = pipe.get(), .events = POLLIN, .revents = 0};
  std::array<char, 65536> bytes{};
  std::string read;
  while (wait.revents != POLLHUP && player.isRunning()) {
    if (::poll(&wait, 1, 100) <= 0) continue;
    if (const auto got = ::read(pipe.get(), bytes.data(), bytes.size()); got > 0) read.append(bytes.data(), got);
  }
  EXPECT_EQ(player.wait(), 0) << textOf("said.txt");
  EXPECT_THAT(read, testing::StartsWith("YUV4MPEG2 "));
}

// An @ that no rate follows is part of the file's name, for the guard as for the display.
TEST_F(PlayerProgram, ACaptureOntoTheFilmIsRefusedWhateverItsName) {
  for (const char* film : {"a@b.mkv", "film.mkv"}) {
    makeClip(at(film), {color(3), depth(3)});
    for (const char* rate : {"", "@25"}) {
      const auto result = play(at(film), "offscreen:" + at(film) + rate);
      expectOneLine(result, 2, "would be overwritten");
    }
    EXPECT_EQ(runProgram("relievo probe " + at(film), at("")).exit_code, 0) << "the film is still one";
  }
}

TEST_F(PlayerProgram, NoOutputReplacesWhatTheRunReads) {
  makeClip(at("film.mkv"), {color(3), depth(3)});
  makeClip(at("p-%02d.png"), {{.codec = "png", .pix_fmt = "rgb24", .frames = 3}});
  std::ofstream(at("keys.toml")) << "[always]\nRIGHT = \"seek +5\"\n";
  std::ofstream(at("relievo.toml")) << "[play]\nloop = false\n";
  std::ofstream(at("camera.txt")) << "law = linear\n";
  std::ofstream(at("film.en.srt")) << "1\n00:00:00,000 --> 00:00:01,000\nword\n";
  std::ofstream(at("rig.toml")) << "[depth]\nsize = [64, 48]\nfocal = [60, 60]\ncenter = [31.5, 23.5]\nunit_mm = 1\n"
                                   "[color]\nsize = [64, 48]\nfocal = [60, 60]\ncenter = [31.5, 23.5]\n"
                                   "[depth_to_color]\nrotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
                                   "translation_mm = [-15, 0, 0]\n";
  std::ofstream(at("list.m3u")) << "film.mkv\n";
  struct Read {
    std::string file, words;
  };
  const std::string film = at("film.mkv");
  for (const auto& [file, words] :
       {Read{"keys.toml", film + " --keys " + at("keys.toml")},
        Read{"relievo.toml", film + " --config " + at("relievo.toml")},
        Read{"camera.txt", film + " --calibration " + at("camera.txt")},
        Read{"rig.toml", film + " --registration " + at("rig.toml")}, Read{"film.en.srt", film},
        Read{"list.m3u", at("list.m3u")}, Read{"film.mkv", at("list.m3u")}, Read{"film.mkv", "file:" + film},
        Read{"p-02.png", at("p-%02d.png")}}) {
    const std::string before = contentOf(at(file));
    for (const char* option : {" --report ", " --record "}) {
      expectOneLine(play(words + option + at(file)), 2, file + ": is also an input and would be overwritten");
    }
    expectOneLine(play(words, "offscreen:" + at(file)), 2, file + ": is also an input and would be overwritten");
    EXPECT_EQ(contentOf(at(file)), before) << words;
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

// Whether a calibration is valid may depend on the film.
TEST_F(PlayerProgram, ACalibrationThatDoesNotFitTheFilmIsWrongUse) {
  ClipTrack bytes = depth(3);
  bytes.pix_fmt = "gray";
  makeClip(at("film.mkv"), {color(3), bytes});
  for (const char* words : {"invalid=300", "bits=12", "near=6000"}) {
    expectOneLine(play(at("film.mkv") + " --calibration " + words), 2, "calibration");
    const auto probed = runProgram("relievo probe " + at("film.mkv") + " --calibration " + words, at(""));
    EXPECT_EQ(probed.exit_code, 2) << probed.err;
  }
  std::ofstream(at("camera.txt")) << "near = 6000\n";
  expectOneLine(play(at("film.mkv") + " --calibration " + at("camera.txt")), 1, "calibration");
}

TEST_F(PlayerProgram, AScriptThatIsMissingOrWrongIsOneLine) {
  std::ofstream(at("keys.txt")) << "1 PLAY\n2 PLAZ\n";
  std::ofstream(at("hand.csv")) << "t_s,x_mm,y_mm,z_mm\n0,1,2\n";
  expectOneLine(play("film.mkv --remote script:" + at("none.txt")), 1, "none.txt: ");
  expectOneLine(play("film.mkv --remote script:" + at("keys.txt")), 2, "keys.txt:2: ");
  expectOneLine(play("film.mkv --haptic sim:" + at("none.csv")), 1, "none.csv: ");
  expectOneLine(play("film.mkv --haptic sim:" + at("hand.csv")), 2, "hand.csv:2: ");
}

TEST_F(PlayerProgram, WhatWasAskedForAndDidNotHappenIsAFailure) {
  const auto silent = play("udp://127.0.0.1:47391 --duration 1");
  EXPECT_EQ(silent.exit_code, 1);
  EXPECT_THAT(silent.err, HasSubstr("udp://127.0.0.1:47391: --duration ended before the first picture came"));
  makeClip(at("film.mkv"), {color(), depth()});
  ::setenv("XDG_STATE_HOME", at("film.mkv").c_str(), 1);  // a file, where a folder is to be
  expectOneLine(play(at("film.mkv") + " --resume"), 1, "its folder cannot be made; choose another folder (Not a dir");
  ::setenv("XDG_STATE_HOME", at("state").c_str(), 1);
  fs::create_directories(at("state/relievo"));
  fs::create_symlink("/dev/full", at("state/relievo/resume.json"));
  const auto full = play(at("film.mkv") + " --resume");
  EXPECT_EQ(full.exit_code, 1) << full.err;
  ::unsetenv("XDG_STATE_HOME");
}

TEST_F(PlayerProgram, AWrongKeyTableIsNamedByItsLine) {
  std::ofstream(at("keys.toml")) << "[always]\nRIGHT = \"dance\"\n";
  expectOneLine(play("film.mkv --keys " + at("keys.toml")), 2, "keys.toml:2");
}

}  // namespace
}  // namespace relievo::test
