// SPDX-License-Identifier: Apache-2.0
// Where films were left: what survives, in which order, and what a damaged file does.
#include "app/player/film/resume.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "platform/log.h"
#include "tests/support/machine/process.h"

namespace relievo {
namespace {

class ResumeTest : public testing::Test {
 protected:
  ResumeTest() { setLogLevel(LogLevel::Error); }
  ~ResumeTest() override { std::filesystem::remove_all(folder_); }

  static double at(const Resume& resume, const std::string& url) {
    const auto position = resume.find(url);
    return position ? toSeconds(*position) : -1;
  }
  void write(const std::string& text) {
    std::filesystem::create_directories(folder_);
    std::ofstream(path_) << text;
  }

  FileWriter files_{FileWriter::Where::AtOnce};
  std::filesystem::path folder_ = testing::TempDir() + "resume-" + std::to_string(::getpid());
  std::string path_ = folder_ / "deep/resume.json";
};

TEST_F(ResumeTest, PositionsOutliveTheProgram) {
  {
    FileWriter files;
    Resume resume(path_, files);
    EXPECT_FALSE(resume.last());
    resume.keep("a.mkv", mediaTime(61.5));
    resume.keep("http://b/c d.mkv?e=\"f\"", mediaTime(7));
    resume.keep("a.mkv", mediaTime(62.5));
  }
  const Resume again(path_, files_);
  EXPECT_DOUBLE_EQ(at(again, "a.mkv"), 62.5);
  EXPECT_EQ(at(again, "http://b/c d.mkv?e=\"f\""), 7);
  EXPECT_EQ(at(again, "other"), -1);
  EXPECT_EQ(again.last(), Resume::keyOf("a.mkv"));
}

TEST_F(ResumeTest, AFilmThatStandsIsWrittenOnce) {
  Resume resume(path_, files_);
  resume.keep("a.mkv", mediaTime(10));
  std::filesystem::remove(path_);
  resume.keep("a.mkv", mediaTime(10));
  EXPECT_FALSE(std::filesystem::exists(path_));
  resume.keep("a.mkv", mediaTime(11));
  EXPECT_TRUE(std::filesystem::exists(path_));
}

TEST_F(ResumeTest, AFilmIsTheSameByWhateverPathItIsNamed) {
  Resume resume(path_, files_);
  resume.keep("films/a.mkv", mediaTime(10));
  const auto here = std::filesystem::current_path();
  EXPECT_EQ(at(resume, here / "lists/../films/a.mkv"), 10);
  EXPECT_EQ(at(resume, here.parent_path() / "films/a.mkv"), -1) << "another one";
  EXPECT_EQ(Resume::keyOf("http://a/../b"), "http://a/../b");
}

TEST_F(ResumeTest, WhatHasEndedOrHardlyBegunIsForgotten) {
  Resume resume(path_, files_);
  resume.keep("a", mediaTime(10));
  resume.keep("b", mediaTime(10));
  resume.forget("a");
  resume.keep("b", mediaTime(1.9));
  EXPECT_EQ(at(resume, "a"), -1);
  EXPECT_EQ(at(resume, "b"), -1);
}

TEST_F(ResumeTest, TheOldestFilmsAreDropped) {
  Resume resume(path_, files_);
  for (int i = 0; i < 250; ++i) resume.keep(std::to_string(i), mediaTime(10));
  EXPECT_EQ(at(resume, "49"), -1);
  EXPECT_EQ(at(resume, "50"), 10);
}

TEST_F(ResumeTest, OfADamagedFileWhatMakesSenseIsKept) {
  path_ = folder_ / "resume.json";
  write(
      R"([["/good", 5], ["late", 1e9], ["before", -1], [7, 7], ["long", 1, 2], "x", ["word", "5"], ["/good too", 6.5]])");
  const Resume resume(path_, files_);
  EXPECT_EQ(at(resume, "/good"), 5);
  EXPECT_DOUBLE_EQ(at(resume, "/good too"), 6.5);
  for (const char* url : {"late", "before", "long", "x", "word"}) EXPECT_EQ(at(resume, url), -1) << url;
  for (const char* text : {"", "{", "[[\"good\", 5]", "{\"good\": 5}", "\xff\xfe"}) {
    write(text);
    EXPECT_FALSE(Resume(path_, files_).last()) << text;
  }
}

TEST_F(ResumeTest, WhereNothingCanBeWrittenItGoesOnWithout) {
  Resume resume("/proc/nowhere/resume.json", files_);
  EXPECT_TRUE(resume.isKept()) << "nothing to write";
  resume.keep("a", mediaTime(10));
  EXPECT_EQ(at(resume, "a"), 10);
  EXPECT_FALSE(resume.isKept());
  Resume other(path_, files_);
  other.keep("a", mediaTime(10));
  EXPECT_TRUE(other.isKept());
}

// Killed at any moment, the file is the old one or the new one.
TEST_F(ResumeTest, AKillLeavesAWholeFile) {
  for (int round = 0; round < 10; ++round) {
    test::Process keeper({PLACE_KEEPER, path_}, testing::TempDir() + "place-keeper.txt");
    // A busy machine may be long in coming to the first file.
    for (int i = 0; i < 10'000 && !std::filesystem::exists(path_); ++i) ::usleep(1'000);
    ::usleep(static_cast<useconds_t>(3'000 * round));
    keeper.send(SIGKILL);
    ASSERT_EQ(keeper.wait(), -SIGKILL);
    ASSERT_TRUE(std::filesystem::exists(path_));
    std::ifstream file(path_);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    EXPECT_TRUE(text.starts_with("[") && text.ends_with("]\n")) << text.size();
    EXPECT_TRUE(Resume(path_, files_).last());
  }
}

TEST_F(ResumeTest, TheServicesFolderGoesBeforeThePersons) {
  ::setenv("HOME", "/home/you", 1);
  ::unsetenv("XDG_STATE_HOME");
  ::unsetenv("STATE_DIRECTORY");
  EXPECT_EQ(Resume::defaultPath(), "/home/you/.local/state/relievo/resume.json");
  ::setenv("XDG_STATE_HOME", "/state", 1);
  EXPECT_EQ(Resume::defaultPath(), "/state/relievo/resume.json");
  ::setenv("STATE_DIRECTORY", "/var/lib/relievo", 1);
  EXPECT_EQ(Resume::defaultPath(), "/var/lib/relievo/resume.json");
  for (const char* name : {"XDG_STATE_HOME", "STATE_DIRECTORY"}) ::setenv(name, "state", 1);
  EXPECT_EQ(Resume::defaultPath(), "/home/you/.local/state/relievo/resume.json") << "relative ones are ignored";
  ::setenv("HOME", ".", 1);
  EXPECT_EQ(Resume::defaultPath(), "");
}

}  // namespace
}  // namespace relievo
