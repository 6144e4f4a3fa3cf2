// SPDX-License-Identifier: Apache-2.0
// Options shared by the programs, and the one-line message for a wrong one.
#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <expected>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/scene/display_volume.h"
#include "platform/failure.h"
#include "platform/text/lower_case.h"
#include "platform/text/near_words.h"

namespace relievo {

// Thrown through CLI11 by the reader of an option's value; printed by `parseCommandLine`.
struct WordFailure final : std::exception, Failure {
  explicit WordFailure(Failure failure) : Failure(std::move(failure)) {}
};

// Thrown through CLI11 by `--as help`; `parseCommandLine` then prints the list of kinds.
struct KindsAsked final : std::exception {};

// Parses "160x90x40" into as many positive, finite numbers as `sizes` holds; false for anything else.
[[nodiscard]] bool parseSizes(std::string_view text, std::span<double> sizes) noexcept;

// "; did you mean NEAR?" if one of the words is near, else "".
[[nodiscard]] std::string meant(std::string_view wanted, std::span<const std::string> words);

// The word as CLI11 takes it whole: where many are allowed, it takes "[2019,2020]" as two. If that is a file's name,
// "./[2019,2020]".
[[nodiscard]] std::string singleWord(const std::string& word);

// Adds an option that takes one of a few words, in small or capital letters. `value` must outlive the parsing and holds
// the default.
template <class T>
CLI::Option* addChoice(CLI::App& app, const char* option, T& value,
                       std::vector<std::pair<std::string, std::type_identity_t<T>>> choices, const char* help) {
  std::string words, usual;
  std::vector<std::string> all;
  for (const auto& choice : choices) {
    words += (words.empty() ? "" : "|") + choice.first;
    all.push_back(choice.first);
    if (choice.second == value) usual = choice.first;
  }
  const auto choose = [&value, option, choices = std::move(choices), words, all](const std::string& word) {
    for (const auto& [known, meaning] : choices) {
      if (lowerCase(word) != known) continue;
      value = meaning;
      return;
    }
    throw CLI::ValidationError(option + (" " + word), "use one of " + words + meant(word, all));
  };
  return app.add_option_function<std::string>(option, choose, help)->type_name(words)->default_str(usual);
}

// For CLI11's `check`: a number within bounds. Unlike CLI::Range it rejects NaN.
[[nodiscard]] CLI::Validator between(double low, double high);

// Adds --as, --packing, --depth-code, --registration and --calibration, which may be repeated: a later value of a key
// overrides an earlier one.
void addDepthOptions(CLI::App& app, SourceOptions& source);
// Adds --material KEY=VALUE,..
void addMaterialOption(CLI::App& app, SourceOptions& source);
// The same option; a value FILE or SECONDS=FILE,.. is stored in `maps` without being parsed.
void addMaterialOption(CLI::App& app, SourceOptions& source, std::string& maps);
// Adds --fps.
void addRateOption(CLI::App& app, SourceOptions& source);
// Adds --box.
void addBoxOption(CLI::App& app, std::optional<DisplayVolume>& volume);

// Parses the command line. Adds --version to every command. In the help, an option's default follows the first line of
// its text; the first line of a description precedes the usage, the others follow it. After a usage error, --help or
// --version everything has been printed, and the exit code is returned.
[[nodiscard]] std::expected<void, int> parseCommandLine(CLI::App& program, int argc, const char* const* argv);

}  // namespace relievo
