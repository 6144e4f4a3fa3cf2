// SPDX-License-Identifier: Apache-2.0
// Fills a command's options from the configuration's [play], and writes them back as configuration: options are
// declared once, for CLI11, and the configuration can set all of them.
#pragma once

#include <map>
#include <string>

#include "app/player/setup/config_file.h"
#include "platform/failure.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
}

namespace relievo {

// The lines that options have come from, by their keys.
using ConfigLines = std::map<std::string, int>;

// Call after the command line was parsed: sets each option that it has not given to its words in [play]. A key is an
// option's long name, or an argument's in small letters. The failure names the file's line: InvalidArgument for a key
// that is no option and for a value that the option refuses; else the option's own.
[[nodiscard]] Outcome<ConfigLines> applyConfig(CLI::App& command, const FileConfig& config);

// TOML that `loadConfig` and `applyConfig` read back: every option of the command and every other entry of the
// configuration, each with a comment that states its origin. Options that are not set are commented out.
[[nodiscard]] std::string configText(const CLI::App& command, const FileConfig& config, const ConfigLines& lines);

}  // namespace relievo
