// SPDX-License-Identifier: Apache-2.0
// The configuration file (TOML): what a machine's hardware needs and no command line should have to say every time.
#pragma once

#include <optional>
#include <string>

#include "platform/failure.h"

namespace relievo {

// [falcon]
// firmware = "/path/to/image"     # the maker's firmware
// counts_per_nm = 6000            # of a motor word, as `relievo devices calibrate` has found it
struct FileConfig {
  std::optional<std::string> falcon_firmware;
  std::optional<double> falcon_counts_per_nm;
};

// $XDG_CONFIG_HOME/relievo/relievo.toml, or the same under ~/.config, if it is there; else /etc/relievo/relievo.toml.
[[nodiscard]] std::string defaultConfigPath();

// `path` empty: the default one, and no file is no failure. NotFound; InvalidArgument, which names the line, for what
// is no TOML, for an unknown key and for a value that cannot be.
[[nodiscard]] Outcome<FileConfig> loadConfig(const std::string& path);

// The file's text with one number set, everything else as it was, comments too. `text` is TOML that `loadConfig`
// has read.
[[nodiscard]] std::string withNumber(const std::string& text, const std::string& table, const std::string& key,
                                     double value);

// The same in the file itself, which is made with its folder where there is none.
[[nodiscard]] Outcome<void> setNumber(const std::string& path, const std::string& table, const std::string& key,
                                      double value);

}  // namespace relievo
