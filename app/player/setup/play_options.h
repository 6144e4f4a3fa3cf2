// SPDX-License-Identifier: Apache-2.0
// Declares the options of `relievo play` for CLI11, and converts their words to values.
#pragma once

#include <CLI/CLI.hpp>

#include "app/player/setup/options.h"

namespace relievo {

// The arguments must outlive the parsing. A wrong word throws, as in CLI11.
void addPlayOptions(CLI::App& command, PlayOptions& play, const DeviceNames& names);
// Adds --depth, and the options for reading a source and its depth, for every command that takes a source.
void addDepthSource(CLI::App& command, SourceOptions& source);
// Answers options of other players that relievo does not have: with the way to do the same.
void answerOptionsOfOthers(CLI::App& command);

}  // namespace relievo
