// SPDX-License-Identifier: Apache-2.0
// Declares the options of `relievo play` for CLI11, and turns their words into values.
#pragma once

#include <CLI/CLI.hpp>

#include "app/player/setup/options.h"

namespace relievo {

// What is given must outlive the parsing. A wrong word throws, as CLI11 does.
void addPlayOptions(CLI::App& command, PlayOptions& play, const DeviceNames& names);
// --depth, and how a source and its depth are read: of every command that takes a source.
void addDepthSource(CLI::App& command, SourceOptions& source);

}  // namespace relievo
