// SPDX-License-Identifier: Apache-2.0
// The configuration file (TOML): settings of a machine's hardware that no command line should have to repeat.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/failure.h"

namespace relievo {

// [play]                          # any option of `relievo play` by its long name, SOURCE as source
// display = "kms"
// [falcon]
// firmware = "/path/to/image"     # the maker's firmware
// counts_per_nm = 6000            # of a motor word, as `relievo devices calibrate` has found it
// [log]                           # error, warning, info, debug; all, and then areas that differ
// haptic = "debug"
struct ConfigEntry {
  std::string table, key;
  std::vector<std::string> words;  // as on a command line; several of a list
  int line = 0;
};

struct FileConfig {
  std::string path;                  // empty: there is none
  std::vector<ConfigEntry> entries;  // all of them, by table and key
  std::optional<std::string> falcon_firmware;
  std::optional<double> falcon_counts_per_nm;
};

// $XDG_CONFIG_HOME/relievo/relievo.toml, or the same under ~/.config, if it is there; else /etc/relievo/relievo.toml.
[[nodiscard]] std::string defaultConfigPath();

// If `path` is empty, reads the default file; it is no failure if that is missing. NotFound; InvalidArgument, which
// names the line, for invalid TOML, an unknown table, and, outside [play], an unknown key or a value that is out of
// range. The contents of [play] are checked by the options (config_options.h).
[[nodiscard]] Outcome<FileConfig> loadConfig(const std::string& path);
// The same for a text; `path` is only for messages.
[[nodiscard]] Outcome<FileConfig> parseConfig(const std::string& text, const std::string& path);

// Applies the levels of [log].
void applyLogLevels(const FileConfig& config);

// "relievo.toml:12: key", for a message about an entry.
[[nodiscard]] std::string placeOf(const FileConfig& config, const ConfigEntry& entry);
// A TOML value that reads back as these words: a number if that preserves them, else text in quotes; several become a
// list.
[[nodiscard]] std::string tomlOf(const std::vector<std::string>& words);

// The file's text with one number set and everything else unchanged, comments included. `text` is TOML that
// `loadConfig` has read; nullopt for a table that is written inline.
[[nodiscard]] std::optional<std::string> withNumber(const std::string& text, const std::string& table,
                                                    const std::string& key, double value);

// The same in the file itself; creates the file and its folder if they are missing.
[[nodiscard]] Outcome<void> setNumber(const std::string& path, const std::string& table, const std::string& key,
                                      double value);

}  // namespace relievo
