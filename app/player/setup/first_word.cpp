// SPDX-License-Identifier: Apache-2.0
// Compares it with the program's commands.
#include "app/player/setup/first_word.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>

#include "platform/files/answered_place.h"
#include "platform/near_words.h"

namespace relievo {

std::vector<const char*> withCommand(const CLI::App& program, int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  const std::string first = argc > 1 ? argv[1] : "";
  const auto isCommand = [&program](const std::string& word) {
    const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
    return std::ranges::any_of(commands, [&word](const CLI::App* each) { return each->get_name() == word; });
  };
  if (first == "help") {
    words.erase(words.begin() + 1);
    words.push_back("--help");
    return words;
  }
  if (argc == 2 && first == "-v") return {argv[0], "--version"};
  constexpr std::array<std::string_view, 4> kOwn{"-h", "--help", "-V", "--version"};
  if (!isCommand(first) && std::ranges::find(kOwn, first) == kOwn.end()) words.insert(words.begin() + 1, "play");
  return words;
}

Outcome<void> refuseMisspeltCommand(const CLI::App& program, const std::string& word) {
  std::vector<std::string> commands;
  for (const CLI::App* each : program.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(each->get_name());
  }
  const std::string near = nearestWord(word, commands);
  if (near.empty() || near == word || word.find_first_of("./:") != std::string::npos) return {};
  if (isThere(word)) return {};
  return failOn(word + " (" + near + "?)",
                {ErrorCode::InvalidArgument, 0, "is neither a file nor a command; see relievo --help"});
}

}  // namespace relievo
