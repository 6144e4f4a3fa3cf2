// SPDX-License-Identifier: Apache-2.0
// The manual pages and completions list all options of the programs and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using Words = std::set<std::string>;

std::string outputOf(const std::string& command) {
  std::string text;
  FILE* const pipe = ::popen(command.c_str(), "r");  // NOLINT(bugprone-command-processor): the test's command
  for (int c; pipe != nullptr && (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  EXPECT_EQ(pipe == nullptr ? -1 : ::pclose(pipe), 0) << command;
  return text;
}

// What bash offers to complete for these words, the last of them unfinished.
Words offered(const std::string& words) {
  const std::string program = words.substr(0, words.find(' '));
  std::string function = "_" + program;
  std::ranges::replace(function, '-', '_');
  std::istringstream text(outputOf("bash -c '. " RELIEVO_MANUAL_DIR "/" + program + ".bash; COMP_WORDS=(" + words +
                                   "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); " + function +
                                   "; printf \"%s\\n\" \"${COMPREPLY[@]}\"'"));
  return {std::istream_iterator<std::string>(text), {}};
}

Words found(const std::string& text, const std::regex& what) {
  Words words;
  for (std::sregex_iterator at(text.begin(), text.end(), what), end; at != end; ++at) words.insert((*at)[1]);
  return words;
}

class Manual : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] std::string helpOf(const std::string& command) const {
    const auto said = test::runProgram(command + " --help", folder_ / ".");
    EXPECT_EQ(said.exit_code, 0) << command;
    return said.out;
  }
  static Words optionsIn(const std::string& help) {
    return found(help, std::regex("\n  (?:-\\w,)?(--[a-z-]+)", std::regex::ECMAScript));
  }
  static Words commandsIn(const std::string& help) {
    const std::size_t list = help.find("\nCommands:\n");
    if (list == std::string::npos) return {};
    return found(help.substr(list, help.find("\n\n", list + 11) - list), std::regex("\n  ([a-z-]+)"));
  }
  // A command and all its subcommands.
  void walk(const std::string& command, const std::function<void(const std::string&)>& visit) const {
    visit(command);
    for (const std::string& below : commandsIn(helpOf(command))) walk(command + " " + below, visit);
  }
  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(All, Manual, testing::Values("relievo", "relievo-author", "relievo-lab"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(Manual, TheCompletionOffersTheOptionsAndCommandsOfTheHelp) {
  walk(GetParam(), [this](const std::string& command) {
    SCOPED_TRACE(command);
    const std::string help = helpOf(command);
    EXPECT_GE(optionsIn(help).size(), 1u);
    Words options = optionsIn(help);
    if (command == "relievo") options.merge(optionsIn(helpOf("relievo play")));  // a film may follow
    EXPECT_EQ(offered(command + " --"), options);
    Words commands = commandsIn(help);
    if (command == "relievo") commands.insert("help");
    EXPECT_EQ(offered(command + " \"\""), commands);
  });
}

TEST_P(Manual, ThePageHasThemAll) {
  std::string page = outputOf(std::string("zcat " RELIEVO_MANUAL_DIR "/") + GetParam() + ".1.gz");
  page = std::regex_replace(page, std::regex("\\\\f.|\\\\(?=-)"), "");
  walk(GetParam(), [&](const std::string& command) {
    EXPECT_THAT(page, testing::HasSubstr("\n" + command + " [OPTIONS]")) << "among the synopses";
    for (const std::string& option : optionsIn(helpOf(command))) {
      EXPECT_TRUE(std::regex_search(page, std::regex("\n(-.,)?" + option + "\\b"))) << command << " " << option;
    }
  });
}

TEST(Completion, KnowsTheWordsOfAChoiceAndTheNamesOfDevices) {
  EXPECT_EQ(offered("relievo play film.mkv --packing \"\""),
            (Words{"auto", "tracks", "sbs", "tb", "sbs-depth-first", "tb-depth-first", "alpha", "depth-alone",
                   "stereo-sbs", "stereo-tb", "stereo-tracks"}));
  EXPECT_EQ(offered("relievo play --display \"\""), (Words{"kms", "window", "offscreen", "mock"}));
  EXPECT_EQ(offered("relievo play --haptic p"), (Words{"polhem", "pointer"}));
  EXPECT_EQ(offered("relievo play --haptic g"), Words{"gamepad"});
  EXPECT_EQ(offered("relievo play --haptic i"), Words{"inverse3"});
  EXPECT_EQ(offered("relievo-lab trace --method p"), (Words{"penalty", "proxy-graph", "proxy-blend"}));
  EXPECT_EQ(offered("relievo play film"), Words{}) << "a file is bash's to complete";
  EXPECT_EQ(offered("relievo film.mkv --stereo t"), Words{"tab"}) << "without the command play";
  EXPECT_EQ(offered("relievo --haptic p"), (Words{"polhem", "pointer"}));
  EXPECT_EQ(offered("relievo devices calibrate --l"), Words{}) << "that is an option of play";
  EXPECT_EQ(offered("relievo help p"), (Words{"play", "probe"}));
  EXPECT_EQ(offered("relievo help --l"), Words{});
}

// What zsh would offer: its own functions are replaced by some that print.
Words offeredByZsh(const std::string& words, int current, const std::string& prefix) {
  std::istringstream text(outputOf(
      "zsh -f -c 'compadd() { shift; print -l -- $@ }; _describe() { print -l -- ${(P)${@[-1]}%%:*} }; _files() {}; "
      "words=(" +
      words + "); CURRENT=" + std::to_string(current) + "; PREFIX=" + prefix +
      "; complete_it() { . " RELIEVO_MANUAL_DIR "/relievo.zsh }; complete_it'"));
  return {std::istream_iterator<std::string>(text), {}};
}

TEST(Completion, OfZshOffersTheSame) {
  if (std::system("command -v zsh >/dev/null") != 0) GTEST_SKIP() << "zsh is not here";
  for (const char* line :
       {"relievo", "relievo play", "relievo devices", "relievo devices calibrate", "relievo probe"}) {
    const int words = static_cast<int>(std::ranges::count(std::string(line), ' ')) + 1;
    EXPECT_EQ(offeredByZsh(line, words + 1, "-"), offered(std::string(line) + " --")) << line;
  }
  EXPECT_EQ(offeredByZsh("relievo", 2, "\"\""), (Words{"play", "probe", "devices", "selftest", "help"}));
  EXPECT_EQ(offeredByZsh("relievo help", 3, "\"\""), (Words{"play", "probe", "devices", "selftest"}));
  EXPECT_EQ(offeredByZsh("relievo film.mkv --stereo", 4, "\"\""), offered("relievo film.mkv --stereo \"\""));
}

}  // namespace
}  // namespace relievo
