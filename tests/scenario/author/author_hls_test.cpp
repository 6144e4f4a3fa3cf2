// SPDX-License-Identifier: Apache-2.0
// HLS films of relievo-author: names, segments, several authors at once, what a killed run has left.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/author/author.h"
#include "app/author/package/output.h"
#include "tests/scenario/author/author_film.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/process.h"

namespace relievo {
namespace {

using test::makeClip;
using test::Process;
using testing::ElementsAre;
using testing::HasSubstr;

// A playlist contains URLs, so its segments get names without special characters.
TEST_F(AuthorFilm, WritesAnHlsFilmOfAnyNameThatOthersCanRead) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int k) { return 8u * static_cast<unsigned>(k); })});
  const SourceOptions source{.url = folder_ / "color.mkv", .depth_url = folder_ / "depth.mkv"};
  for (const char* name : {"50%.m3u8", "a%05d.m3u8", "a:b.m3u8", "a\"b.m3u8", "a\\b.m3u8", "a#b.m3u8", "a?b.m3u8",
                           "a b.m3u8", "d\xc3\xa9j\xc3\xa0 \xe8\xa6\x8b.m3u8", "in 5% : of/a ?.m3u8"}) {
    std::filesystem::create_directories(std::filesystem::path(folder_ / name).parent_path());
    const auto summary = make(source, name);
    ASSERT_TRUE(summary) << name << ": " << summary.error().error.message;
    std::ofstream(folder_ / "said/name") << (folder_ / name);
    Process ffmpeg(
        {"/bin/bash", "-c", "ffmpeg -v error -i \"file:$(cat " + (folder_ / "said/name") + ")\" -map 0:v:0 -f null -"},
        folder_ / "said/errors");
    EXPECT_EQ(ffmpeg.wait(), 0) << name << textOf(folder_ / "said/errors");
    EXPECT_EQ(readFilm(folder_ / name).pairs.size(), 30u) << name;
  }
}

TEST_F(AuthorFilm, NeverRemovesSegmentsThatAreNotItsOwn) {
  makeClip(folder_ / "film.mkv", {colorTrack(), depthTrack("gray", [](int, int, int) { return 9u; })});
  std::filesystem::create_directories(folder_ / "out.segments");
  std::ofstream(folder_ / "out.segments/thesis.txt") << "four years";
  const OutputOptions forced{.path = folder_ / "out.m3u8", .force = true};
  const auto refused = authorFilm({.url = folder_ / "film.mkv"}, kFfmpeg, forced, stop_, kNoReport);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().error.message, HasSubstr("contains other files"));
  EXPECT_EQ(textOf(folder_ / "out.segments/thesis.txt"), "four years");
}

TEST_F(AuthorFilm, OfThreeAuthorsOfOneNameOneWins) {
  makeClip(folder_ / "film.mkv", {colorTrack(), depthTrack("gray", [](int, int, int) { return 9u; })});
  for (const char* out : {"out.mkv", "out.ts", "out.m3u8"}) {
    const std::string command = std::string(RELIEVO_BIN_DIR) + "/relievo-author --color " + (folder_ / "film.mkv") +
                                " -o " + (folder_ / out) + " >/dev/null 2>&1; echo $? >>" + (folder_ / "said/codes");
    std::filesystem::remove(folder_ / "said/codes");
    Process three({"/bin/bash", "-c", "(" + command + ") & (" + command + ") & (" + command + ") & wait"},
                  folder_ / "said/errors");
    three.wait();
    std::string codes = textOf(folder_ / "said/codes");
    std::erase(codes, '\n');
    std::sort(codes.begin(), codes.end());
    EXPECT_EQ(codes, "011") << out;
    EXPECT_EQ(readFilm(folder_ / out).pairs.size(), 30u) << out;
  }
}

// Simulates a killed run: its folder exists and nobody holds the lock.
TEST_F(AuthorFilm, RemovesWhatAKilledRunOfTheSameNameHasLeft) {
  makeClip(folder_ / "film.mkv", {colorTrack(), depthTrack("gray", [](int, int, int) { return 9u; })});
  for (const char* left :
       {"out.m3u8.relievo-tmp-Ab3dE6/film.segments", "other.m3u8.relievo-tmp-Ab3dE6/film.segments"}) {
    std::filesystem::create_directories(folder_ / left);
  }
  ASSERT_TRUE(make({.url = folder_ / "film.mkv"}, "out.m3u8"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.m3u8.relievo-tmp-Ab3dE6"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "other.m3u8.relievo-tmp-Ab3dE6")) << "of another name";
}

// Removing a folder takes a descriptor, too.
TEST_F(AuthorFilm, LeavesNothingWhereItRunsOutOfDescriptors) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int) { return 9u; })});
  int failed = 0, whole = 0;
  for (int most = 4; most < 14; ++most) {
    const std::string command = "exec </dev/null >/dev/null 2>&1; ulimit -n " + std::to_string(most) +
                                "; exec " RELIEVO_BIN_DIR "/relievo-author --color " + (folder_ / "color.mkv") +
                                " --depth " + (folder_ / "depth.mkv") + " -o " + (folder_ / "out.m3u8");
    const bool done = std::system(command.c_str()) == 0;  // NOLINT(bugprone-command-processor): the test's command
    ++(done ? whole : failed);
    EXPECT_THAT(made(), done ? testing::SizeIs(2) : testing::SizeIs(0)) << "with " << most << " descriptors";
    for (const std::string& name : made()) std::filesystem::remove_all(folder_ / name);
  }
  EXPECT_GT(failed, 0);
  EXPECT_GT(whole, 0);
}

TEST_F(AuthorFilm, ReplacesAnHlsFilmWholeWhenForced) {
  makeClip(folder_ / "color.mkv", {colorTrack()});
  makeClip(folder_ / "depth.mkv", {depthTrack("gray", [](int, int, int k) { return 8u * static_cast<unsigned>(k); })});
  const SourceOptions source{.url = folder_ / "color.mkv", .depth_url = folder_ / "depth.mkv"};
  ASSERT_TRUE(make(source, "out.m3u8").has_value());
  EXPECT_THAT(made(), ElementsAre("out.m3u8", "out.segments"));
  EXPECT_THAT(filesIn(folder_ / "out.segments"), ElementsAre("00000.m4s", "init.mp4"));
  std::ofstream(folder_ / "out.segments/00007.m4s") << "old";
  EXPECT_FALSE(make(source, "out.m3u8").has_value());
  std::filesystem::remove(folder_ / "out.m3u8");
  const auto refused = make(source, "out.m3u8");
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().error.message, HasSubstr("segments already exists"));
  ASSERT_TRUE(authorFilm(source, kFfmpeg, {.path = folder_ / "out.m3u8", .force = true}, stop_, kNoReport));
  EXPECT_THAT(made(), ElementsAre("out.m3u8", "out.segments"));
  EXPECT_THAT(filesIn(folder_ / "out.segments"), ElementsAre("00000.m4s", "init.mp4"));
  EXPECT_EQ(readFilm(folder_ / "out.m3u8").pairs.size(), 30u);
}

}  // namespace
}  // namespace relievo
