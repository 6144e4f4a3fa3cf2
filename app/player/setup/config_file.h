// SPDX-License-Identifier: Apache-2.0
// The configuration file (TOML): what a machine's hardware needs and no command line should have to say every time.
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

// `path` empty: the default one, and no file is no failure. NotFound; InvalidArgument, which names the line, for what
// is no TOML, for an unknown table, and for an unknown key or a value that cannot be outside [play]: what is in there
// the options judge (config_options.h).
[[nodiscard]] Outcome<FileConfig> loadConfig(const std::string& path);
// The same of a text; `path` is for messages.
[[nodiscard]] Outcome<FileConfig> parseConfig(const std::string& text, const std::string& path);

// Takes the levels of [log] into use.
void applyLogLevels(const FileConfig& config);

// "relievo.toml:12: key", for a message about an entry.
[[nodiscard]] std::string placeOf(const FileConfig& config, const ConfigEntry& entry);
// A value that reads back as these words: a number where that keeps them, else text in quotes; a list of several.
[[nodiscard]] std::string tomlOf(const std::vector<std::string>& words);

// The file's text with one number set, everything else as it was, comments too. `text` is TOML that `loadConfig`
// has read.
[[nodiscard]] std::string withNumber(const std::string& text, const std::string& table, const std::string& key,
                                     double value);

// The same in the file itself, which is made with its folder where there is none.
[[nodiscard]] Outcome<void> setNumber(const std::string& path, const std::string& table, const std::string& key,
                                      double value);

}  // namespace relievo
