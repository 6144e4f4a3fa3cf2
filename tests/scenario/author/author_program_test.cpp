// SPDX-License-Identifier: Apache-2.0
// The program relievo-author: its messages, wrong use, signals, full disks; it leaves a whole film or none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include "app/author/author.h"
#include "tests/scenario/author/author_film.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using test::ClipTrack;
using test::makeClip;
using test::Process;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(AuthorFilm, ProgramPackagesAndSaysWhatItDid) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv",
           {depthTrack("gray16le", [](int c, int, int) { return static_cast<std::uint32_t>(1000 * c); })});
  const auto said = run("--color @/color.mkv --depth @/depth.mkv -o @/out.mp4");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("H.264 4:2:0"));
  EXPECT_THAT(said.out, HasSubstr("H.264 4:0:0"));
  EXPECT_THAT(said.out, HasSubstr("16 bits rescaled to 8"));
  EXPECT_THAT(made(), ElementsAre("out.mp4"));
  EXPECT_EQ(readFilm(folder_ / "out.mp4").pairs.size(), 30u);
}

// Of the colour, of the depth: what was asked for was a film of all of both.
TEST_F(AuthorFilm, ProgramMakesAFilmOfABrokenSourceButSaysThatItFailed) {
  for (const char* broken : {"color.mkv", "depth.mkv"}) {
    makeClip(folder_ / "color.mkv", {colorTrack(64, 48, 30, 90)});
    ClipTrack depth = depthTrack("gray", [](int, int, int) { return 9u; });
    depth.frames = 90;
    makeClip(folder_ / "depth.mkv", {depth});
    std::filesystem::resize_file(folder_ / broken, std::filesystem::file_size(folder_ / broken) / 2);
    const auto said = run("--color @/color.mkv --depth @/depth.mkv -o @/out.mkv --force");
    EXPECT_EQ(said.exit_code, 1) << broken;
    EXPECT_THAT(said.out, HasSubstr(std::string(broken) + " lacks at least "));
    EXPECT_THAT(said.err, testing::EndsWith(folder_ / broken + ": it is not whole: only what was there was used; get "
                                                               "the whole file\n"));
    EXPECT_GT(readFilm(folder_ / "out.mkv").pairs.size(), 30u) << broken;
  }
}

TEST_F(AuthorFilm, ProgramDoesNotReplaceAFileUnlessForced) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int) { return 9u; })});
  std::ofstream(folder_ / "out.mkv") << "mine";
  const auto refused = run("--color @/color.mkv --depth @/depth.mkv -o @/out.mkv");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("out.mkv: already exists"));
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  std::string kept;
  std::ifstream(folder_ / "out.mkv") >> kept;
  EXPECT_EQ(kept, "mine");

  EXPECT_EQ(run("--color @/color.mkv --depth @/depth.mkv -o @/out.mkv --force").exit_code, 0);
  EXPECT_EQ(readFilm(folder_ / "out.mkv").pairs.size(), 30u);
  EXPECT_THAT(made(), ElementsAre("out.mkv"));
}

TEST_F(AuthorFilm, ProgramKeepsTheOldFileWhenTheNewOneFails) {
  std::ofstream(folder_ / "out.mkv") << "mine";
  const auto failed = run("--color @/missing.mkv -o @/out.mkv --force");
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("missing.mkv: no such file"));
  EXPECT_EQ(std::count(failed.err.begin(), failed.err.end(), '\n'), 1);
  EXPECT_THAT(made(), ElementsAre("out.mkv"));
}

TEST_F(AuthorFilm, ProgramTellsWrongUseInOneLine) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  for (const char* arguments :
       {"--color @/color.mkv", "-o @/out.mkv", "--scene moon -o @/out.mkv", "--color @/color.mkv -o @/out.avi",
        "--scene sample --color @/color.mkv -o @/out.mkv", "--color @/color.mkv -o @/out.mkv --crf 99",
        "--color @/color.mkv -o @/out.mkv --calibration law=steep", "--color @/color.mkv -o @/out.mkv --packing pile",
        "--color @/color.mkv -o @/out.mkv --depth-from cat --depth-size 4097x4096",
        "--color @/color.mkv -o @/out.mkv --crf 010",
        "--color @/color.mkv -o @/out.mkv --depth-from cat --depth-size 51.7x29"}) {
    const auto said = run(arguments);
    EXPECT_EQ(said.exit_code, 2) << arguments << ": " << said.err;
    EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1) << arguments << ": " << said.err;
    EXPECT_TRUE(said.err.starts_with("relievo-author: ")) << said.err;
  }
  EXPECT_TRUE(made().empty());
}

TEST_F(AuthorFilm, ProgramTellsTheRangeOfAQuality) {
  for (const char* words : {"--crf 99", "--crf 1.5", "--depth-crf x", "--depth-crf=-1"}) {
    const auto said = run(std::string("--color @/color.mkv -o @/out.mkv ") + words);
    EXPECT_EQ(said.exit_code, 2) << words;
    EXPECT_THAT(said.err, HasSubstr(" is not a whole number between 0 and 51")) << words;
  }
}

TEST_F(AuthorFilm, ProgramSaysWhenThereIsNoDepth) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  const auto said = run("--color @/color.mkv -o @/out.mkv");
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_THAT(said.err, HasSubstr("no depth in this source; give --depth SOURCE"));
  EXPECT_TRUE(made().empty());
}

// Photos of two views side by side, as JPS marks them (VRex, "JPEG stereoscopic").
TEST_F(AuthorFilm, ProgramAsksForOneOfSeveralPhotosThatHoldMore) {
  for (const char* const name : {"a.jpg", "b.jpg"}) {
    makeClip(folder_ / name, {{.codec = "mjpeg", .pix_fmt = "yuvj420p", .width = 64, .height = 32, .frames = 1}});
    std::string jpeg = test::contentOf(folder_ / name);
    jpeg.insert(2, std::string("\xff\xe3\0\x10_JPSJPS_\0\4\0\4\2\1", 18));
    std::ofstream(folder_ / name, std::ios::binary) << jpeg;
  }
  const auto said = run("--color '@/*.jpg' -o @/out.mkv");
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_THAT(said.err, HasSubstr("these are photos that hold their depth or two views each; name one of them"));
}

// It would wait for what writes into the pipe, or for the server, in the middle of the work.
TEST_F(AuthorFilm, ProgramTakesPaintingsFromFilesAlone) {
  const std::string pipe = folder_ / "pipe.png";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& painting : {pipe, std::string("http://127.0.0.1:9/a.png"), std::string("/dev/zero")}) {
    const auto said = run("--color @/color.mkv --depth @/depth.mkv -o @/out.mkv --material 0=" + painting);
    EXPECT_EQ(said.exit_code, 1) << painting;
    EXPECT_THAT(said.err, HasSubstr(painting + ": a painting is a file of this machine"));
  }
}

// It reads the film twice. A film that can be read twice is opened, by its address as well.
TEST_F(AuthorFilm, ProgramMakesDepthFromViewsInFilesAlone) {
  const std::string pipe = folder_ / "pipe.mkv";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& film : {pipe, std::string("http://127.0.0.1:9/a.mkv"), std::string("/dev/zero")}) {
    const auto said = run("--color " + film + " --depth-from stereo -o @/out.mkv");
    EXPECT_EQ(said.exit_code, 1) << film;
    EXPECT_THAT(said.err, HasSubstr(film + ": depth from two views reads the film twice"));
  }
  makeClip(folder_ / "color.mkv", {colorTrack()});
  for (const char* film : {"@/color.mkv", "file://@/color.mkv"}) {
    const auto said = run(std::string("--color ") + film + " --depth-from stereo -o @/out.mkv");
    EXPECT_THAT(said.err, HasSubstr("not a film of two views")) << film;
  }
}

TEST_F(AuthorFilm, ProgramsHelpNamesItsMainOptions) {
  const auto said = run("--help");
  EXPECT_EQ(said.exit_code, 0);
  for (const char* word :
       {"--color", "--depth", "--packing", "--calibration", "--crf", "--force", "--scene", "Examples"}) {
    EXPECT_THAT(said.out, HasSubstr(word));
  }
}

TEST_F(AuthorFilm, ProgramLeavesNothingOnASignal) {
  for (const auto& [number, out] : {std::pair{SIGINT, "out.mkv"},
                                    {SIGTERM, "out.ts"},
                                    {SIGHUP, "out.m3u8"},
                                    {SIGUSR1, "out.m3u8"},
                                    {SIGXCPU, "out.mkv"},
                                    {SIGIO, "out.mkv"}}) {
    Process process({std::string(RELIEVO_BIN_DIR) + "/relievo-author", "--scene", "sample", "-o", folder_ / out},
                    folder_ / "said/errors");
    while (!process.catches(number) && process.isRunning()) std::this_thread::yield();
    ASSERT_TRUE(process.isRunning()) << textOf(folder_ / "said/errors");
    process.send(number);
    EXPECT_EQ(process.wait(), 1);
    EXPECT_THAT(textOf(folder_ / "said/errors"), HasSubstr(std::string(out) + ": interrupted; nothing was written"));
    EXPECT_TRUE(made().empty());
  }
}

// A killed run may leave temporary files where unnamed files are not supported, and for HLS; never an incomplete film.
TEST_F(AuthorFilm, ProgramLeavesNoFilmWhenItIsKilled) {
  for (const char* out : {"out.mkv", "out.mp4", "out.ts", "out.m3u8"}) {
    Process process({std::string(RELIEVO_BIN_DIR) + "/relievo-author", "--scene", "sample", "-o", folder_ / out},
                    folder_ / "said/errors");
    while (!process.catches(SIGHUP) && process.isRunning()) std::this_thread::yield();
    process.send(SIGKILL);
    EXPECT_LT(process.wait(), 0) << "ended by a signal";
    EXPECT_FALSE(std::filesystem::exists(folder_ / out)) << out;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.segments"));
  }
}

TEST_F(AuthorFilm, ProgramEndsAtOnceOnASecondSignalAndLeavesNothing) {
  for (const int second : {SIGINT, SIGHUP}) {
    Process process({std::string(RELIEVO_BIN_DIR) + "/relievo-author", "--scene", "sample", "-o", folder_ / "out.mkv"},
                    folder_ / "said/errors");
    while (!process.catches(SIGHUP) && process.isRunning()) std::this_thread::yield();
    process.sendBoth(SIGTERM, second);
    EXPECT_LT(process.wait(), 0) << "ended by a signal";
    EXPECT_THAT(made(), testing::IsEmpty());
  }
}

TEST_F(AuthorFilm, ProgramLeavesNothingOnAFullDisk) {
  // Files are limited to 16 blocks of 1 KiB, which simulates a full disk.
  ClipTrack color = colorTrack(320, 240);
  color.sample = [](int, int c, int r, int k) {
    return static_cast<std::uint32_t>((c * 7919 + r * 104729 + k * 1299709) >> 3);
  };
  makeClip(folder_ / "color.mkv", {color});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int) { return 9u; })});
  for (const char* out : {"out.mkv", "out.mp4", "out.ts", "out.m3u8"}) {
    Process process({"/bin/bash", "-c",
                     "ulimit -f 16; exec " RELIEVO_BIN_DIR "/relievo-author --color " + (folder_ / "color.mkv") +
                         " --depth " + (folder_ / "depth.mkv") + " -o " + (folder_ / out)},
                    folder_ / "said/errors");
    EXPECT_EQ(process.wait(), 1) << out;
    EXPECT_THAT(textOf(folder_ / "said/errors"),
                HasSubstr(std::string(out) + ": it cannot be written; is the disk full?"));
    EXPECT_TRUE(made().empty()) << out;
  }
}

TEST_F(AuthorFilm, ProgramWritesWhatItsWordsSay) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv",
           {depthTrack("gray16le", [](int c, int, int) { return static_cast<std::uint32_t>(1000 * c); })});
  const auto said =
      run("--color @/color.mkv --depth @/depth.mkv -o @/out.ts --depth-codec hevc --depth-bits 12 --depth-chroma flat "
          "--depth-law inverse --calibration near=500,far=2000 --material friction=.3");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("HEVC 4:2:0, 12 bits"));
  EXPECT_THAT(said.out, HasSubstr("linear steps converted to inverse ones"));
  EXPECT_THAT(said.out, HasSubstr("material: friction=0.3/0.3"));
  EXPECT_EQ(said.err, "");
  const Film film = readFilm(folder_ / "out.ts");
  EXPECT_EQ(film.info.calibration.calibration.law, DepthLaw::Inverse);
  EXPECT_EQ(film.info.calibration.calibration.bits, 12);
  EXPECT_EQ(film.info.calibration.calibration.near_mm, 500);
  EXPECT_EQ(film.info.depth_codec, "hevc");
  EXPECT_EQ(film.info.material.friction, (Friction{0.3, 0.3}));
}

// Other players treat it as ordinary video: they show every colour picture and ignore the depth.
TEST_F(AuthorFilm, OtherPlayersPlayItAsOrdinaryVideo) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int k) { return 8u * static_cast<unsigned>(k); })});
  const SourceOptions source{.url = folder_ / "color.mkv", .depth_url = folder_ / "depth.mkv"};
  const auto shell = [this](const std::string& command) {
    Process process({"/bin/bash", "-c", command + " >" + (folder_ / "said/out")}, folder_ / "said/errors");
    return process.wait();
  };
  const auto isThere = [&](const std::string& program) { return shell("command -v " + program) == 0; };
  // The other program may hang for its own reasons, so one retry. On a busy machine it takes many times
  // as long as alone.
  const auto plays = [&](const std::string& command) {
    constexpr int kTimedOut = 124;
    const std::string bounded = "timeout 60 " + command + " </dev/null";
    const int code = shell(bounded);
    return (code == kTimedOut ? shell(bounded) : code) == 0;
  };
  if (!isThere("ffprobe")) GTEST_SKIP() << "no ffprobe: toolchain/setup demo";
  for (const char* out : {"out.mkv", "out.mp4", "out.mov", "out.ts", "out.m3u8"}) {
    ASSERT_TRUE(make(source, out).has_value());
    const std::string film = folder_ / out;
    ASSERT_EQ(shell("ffprobe -v error -select_streams v:0 -count_frames -show_entries "
                    "stream=codec_name,nb_read_frames,pix_fmt -of csv=p=0 " +
                    film),
              0);
    EXPECT_THAT(textOf(folder_ / "said/out"), testing::StartsWith("h264,yuv420p,30")) << out;
    EXPECT_EQ(textOf(folder_ / "said/errors"), "") << out;
    if (isThere("mpv")) {
      EXPECT_TRUE(plays("mpv --no-config --frames=30 --vo=null --ao=null --untimed " + film)) << out;
    }
    // Its demuxers of transport streams and HLS are in packages of 80 MB.
    const bool plain = film.ends_with(".mkv") || film.ends_with(".mp4") || film.ends_with(".mov");
    if (plain && isThere("gst-launch-1.0")) {
      EXPECT_TRUE(plays("env -u GST_PLUGIN_SYSTEM_PATH_1_0 GST_REGISTRY=" + folder_ / "gstreamer.list" +
                        " gst-launch-1.0 -q playbin uri=file://" + film + " video-sink=fakesink audio-sink=fakesink"))
          << out << ": " << textOf(folder_ / "said/errors");
    }
  }
}

}  // namespace
}  // namespace relievo
