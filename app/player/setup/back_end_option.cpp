// SPDX-License-Identifier: Apache-2.0
// Judges the word, not what follows it.
#include "app/player/setup/back_end_option.h"

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "platform/near_words.h"

namespace relievo {
namespace {

BackEndName nameOf(const std::string& given) {
  BackEndName name = given;
  name.word = inSmallLetters(name.word);
  return name;
}

}  // namespace

CLI::Option* addBackEnd(CLI::App& command, const char* option, BackEndName& chosen, const char* kind, const char* names,
                        const char* help, BackEndName* second) {
  const auto judge = [kind, names](const std::string& given) -> std::string {
    const std::string word = inSmallLetters(BackEndName(given).word);
    std::istringstream all(names);
    std::vector<std::string> words;
    for (std::string known; all >> known;) {
      words.push_back(known.substr(0, known.find_first_of(":[")));
      if (words.back() == word) return "";
    }
    return given + ": no such " + kind + "; it is one of: " + names + meant(word, words);
  };
  const auto take = [option, second, &chosen](const std::vector<std::string>& given) {
    if (given.size() > (second != nullptr ? 2U : 1U)) {
      throw WordFailure(
          {option + (" " + given.back()), {ErrorCode::InvalidArgument, 0, "is one too many; see relievo play --help"}});
    }
    chosen = nameOf(given.front());
    if (given.size() > 1) *second = nameOf(given.back());
  };
  return command.add_option_function<std::vector<std::string>>(option, take, std::string(help) + "\n" + names)
      ->allow_extra_args(false)
      ->default_str(chosen.text())
      ->check(CLI::Validator(judge, ""))
      ->type_name("NAME");
}

}  // namespace relievo
