// SPDX-License-Identifier: Apache-2.0
// What the first word of the command line is: a command, or a film.
#pragma once

#include <string>
#include <vector>

#include "platform/failure.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
}

namespace relievo {

// "relievo film.mkv" and "relievo --loop film.mkv" as "relievo play ..", "relievo help play" as "relievo play --help".
[[nodiscard]] std::vector<const char*> withCommand(const CLI::App& program, int argc, const char* const* argv);

// A misspelt command would be taken for a film.
[[nodiscard]] Outcome<void> refuseMisspeltCommand(const CLI::App& program, const std::string& word);

}  // namespace relievo
