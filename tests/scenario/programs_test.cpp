// SPDX-License-Identifier: Apache-2.0
// Behaviour of the command line that the three programs share.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using testing::HasSubstr;

class Programs : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] test::ProgramResult run(const std::string& words) const {
    return test::runProgram(GetParam() + (" " + words), folder_ / ".");
  }
  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(All, Programs, testing::Values("relievo", "relievo-author", "relievo-lab"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_P(Programs, TellTheirVersion) {
  const auto said = run("--version");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_EQ(said.out, std::string(GetParam()) + " " RELIEVO_VERSION "\n");
  EXPECT_EQ(said.err, "");
}

TEST_P(Programs, NameTheWordThatTheyDoNotKnow) {
  const bool takes_films = std::string(GetParam()) == "relievo";  // a word that is no command is a film
  const auto said = run(takes_films ? "--foo" : "foo");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1) << said.err;
  EXPECT_TRUE(said.err.starts_with(std::string(GetParam()) + ": ")) << said.err;
  if (std::string(GetParam()) == "relievo-lab") {  // the author has no commands: a missing option is reported first
    EXPECT_THAT(said.err, HasSubstr(": foo: unknown command; use one of "));
  }
}

TEST_P(Programs, AnOptionWithoutItsValueIsOneLineThatSaysHowItIsWritten) {
  const std::string program = GetParam();
  const std::string words = program == "relievo"       ? "film.mkv --fps"
                            : program == "relievo-lab" ? "trace --fps"
                                                       : "--fps";
  const std::string command = program == "relievo" ? " play" : program == "relievo-lab" ? " trace" : "";
  for (const std::string& given : {words, words + "= film.mkv"}) {
    const auto said = run(given);
    EXPECT_EQ(said.exit_code, 2);
    EXPECT_EQ(said.err,
              program + ": --fps: its value is missing; write --fps F; see " + program + command + " --help\n");
  }
}

TEST_P(Programs, HelpIsOnStdoutAndNamesTheVersionsOption) {
  const auto said = run("--help");
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_THAT(said.out, HasSubstr("--version"));
  EXPECT_EQ(said.err, "");
}

// Prints the version into `file`, which may hold at most `blocks` blocks.
test::ProgramResult printInto(const std::string& program, const std::string& file, const std::string& blocks) {
  const std::string command =
      "ulimit -f " + blocks + "; exec " RELIEVO_BIN_DIR "/" + program + " --version 2>&1 >" + file;
  std::FILE* const pipe = ::popen(command.c_str(), "r");  // NOLINT(bugprone-command-processor): the test's command
  test::ProgramResult said;
  for (int c = 0; (c = std::fgetc(pipe)) != EOF;) said.err += static_cast<char>(c);
  const int status = ::pclose(pipe);
  said.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return said;
}

TEST_P(Programs, EndQuietlyWhereTheReaderHasReadEnough) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ::close(ends[0]);
  const auto said = printInto(GetParam(), "&" + std::to_string(ends[1]), "unlimited");
  ::close(ends[1]);
  EXPECT_EQ(said.exit_code, 0);
  EXPECT_EQ(said.err, "");
}

TEST_P(Programs, FailWhereStandardOutputIsFull) {
  const auto said = printInto(GetParam(), "/dev/full", "unlimited");
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1) << said.err;
  EXPECT_TRUE(said.err.starts_with(std::string(GetParam()) + ": standard output: ")) << said.err;
}

TEST_P(Programs, FailInsteadOfDyingWhereAFileMayNotGrow) {
  const auto said = printInto(GetParam(), folder_ / "out.txt", "0");
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_TRUE(said.err.starts_with(std::string(GetParam()) + ": standard output: ")) << said.err;
}

TEST(ProgramWords, AMissingFilmIsOneLineWithAnExample) {
  const test::TemporaryFolder folder;
  const auto said = test::runProgram("relievo", folder / ".");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_THAT(said.err, HasSubstr("name a film, as in relievo film.mkv"));
}

TEST(ProgramWords, TheChartsGodObjectIsExplained) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::runProgram("relievo-lab --help", folder / ".").out, HasSubstr("god-object"));
  EXPECT_THAT(test::runProgram("relievo-lab trace --help", folder / ".").out,
              HasSubstr("god-object is relievo with --space triangles"));
}

}  // namespace
}  // namespace relievo
