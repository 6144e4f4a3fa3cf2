// SPDX-License-Identifier: Apache-2.0
// The folders of a desktop's user, under the names of his language.
#pragma once

#include <filesystem>
#include <string>

namespace relievo {

// $XDG_CONFIG_HOME, else ~/.config; empty without a home.
[[nodiscard]] std::filesystem::path configFolder();

// `name`: "XDG_VIDEOS_DIR", ..: as the environment says, else user-dirs.dirs, which desktops write (xdg-user-dirs).
// Empty if neither names one; the home itself means none.
[[nodiscard]] std::filesystem::path userFolder(const std::string& name);

}  // namespace relievo
