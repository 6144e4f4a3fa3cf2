// SPDX-License-Identifier: Apache-2.0
// What becomes of the outputs at the end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "app/player/setup/play_files.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using testing::HasSubstr;

class PlayFiles : public testing::Test {
 protected:
  std::string file(const char* name, const char* text = "a film") {
    const std::string path = folder_ / name;
    std::ofstream(path) << text;
    return path;
  }
  int finish(const PlayReport& report) {
    PlayOutputs outputs;
    auto created = AtomicFile::create(folder_ / "run.json");
    EXPECT_TRUE(created);
    outputs.report = std::move(*created);
    return finishFiles(report, outputs);
  }

  test::TemporaryFolder folder_;
};

// The report names the first 1000 only.
TEST_F(PlayFiles, NoFilmIsReplacedHoweverManyWereOpened) {
  fs::create_hard_link(file("last.mkv"), folder_ / "run.json");
  PlayReport report;
  for (int i = 0; i < 1000; ++i) report.opened.insert(folder_ / ("film-" + std::to_string(i) + ".mkv"));
  EXPECT_EQ(finish(report), 0) << "another file";
  fs::remove(folder_ / "run.json");
  fs::create_hard_link(folder_ / "last.mkv", folder_ / "run.json");
  report.opened.insert(folder_ / "last.mkv");
  EXPECT_EQ(finish(report), 2);
  EXPECT_EQ(contentOf(folder_ / "run.json"), "a film");
  EXPECT_THAT(contentOf(folder_ / "run-2.json"), HasSubstr("\"states\""));
}

TEST_F(PlayFiles, TheDepthOfAFilmIsNotReplacedEither) {
  PlayReport report;
  report.opened.insert(file("film.mkv"));
  fs::create_hard_link(file("film-depth.mkv"), folder_ / "run.json");
  EXPECT_EQ(finish(report), 2);
  EXPECT_EQ(contentOf(folder_ / "run.json"), "a film");
}

}  // namespace
}  // namespace relievo
