// SPDX-License-Identifier: Apache-2.0
// The words that the programs have in common, and one clean line for a word that is wrong.
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

namespace relievo {

// What a reader of an option's words throws through CLI11; `parseCommandLine` tells it.
struct WordFailure final : std::exception, Failure {
  explicit WordFailure(Failure failure) : Failure(std::move(failure)) {}
};

// "160x90x40" into as many positive, finite numbers as `sizes` holds; false when it is anything else.
[[nodiscard]] bool parseSizes(std::string_view text, std::span<double> sizes) noexcept;

// An option whose word is one of a few. `value` outlives the parsing and holds the default.
template <class T>
CLI::Option* addChoice(CLI::App& app, const char* option, T& value,
                       std::vector<std::pair<std::string, std::type_identity_t<T>>> choices, const char* help) {
  std::string words, usual;
  for (const auto& choice : choices) {
    words += (words.empty() ? "" : "|") + choice.first;
    if (choice.second == value) usual = choice.first;
  }
  const auto choose = [&value, option, choices = std::move(choices), words](const std::string& word) {
    for (const auto& [known, meaning] : choices) {
      if (word != known) continue;
      value = meaning;
      return;
    }
    throw CLI::ValidationError(option + (" " + word), "it is one of " + words);
  };
  return app.add_option_function<std::string>(option, choose, help)->type_name(words)->default_str(usual);
}

// For `check`: a number within bounds. CLI::Range lets through what is not a number.
[[nodiscard]] CLI::Validator between(double low, double high);

// --packing, --depth-code, and --calibration, which may come more than once: a later value of a key goes before.
void addDepthOptions(CLI::App& app, SourceOptions& source);
// --volume
void addVolumeOption(CLI::App& app, std::optional<DisplayVolume>& volume);

// Adds --version; the help tells an option's default, where it has one, after the first line of its text. On wrong use,
// and when help or the version was asked for, it has printed what there is to say and answers the exit code.
[[nodiscard]] std::expected<void, int> parseCommandLine(CLI::App& program, int argc, const char* const* argv);

}  // namespace relievo
