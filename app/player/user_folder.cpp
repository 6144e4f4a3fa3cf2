// SPDX-License-Identifier: Apache-2.0
// Reads user-dirs.dirs, lines as XDG_VIDEOS_DIR="$HOME/Videos" (user-dirs.dirs(5)).
#include "app/player/user_folder.h"

#include <sstream>
#include <string_view>

#include "platform/named_folder.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

// The folder between the quotes; a backslash is before a sign that a shell would read otherwise.
fs::path folderIn(std::string_view quoted, const fs::path& home) {
  constexpr std::string_view kHome = "$HOME";
  const bool in_home = quoted.starts_with(kHome);
  if (in_home) quoted.remove_prefix(kHome.size());
  std::string path = in_home ? home.string() : "";
  for (std::size_t i = 0; i < quoted.size() && quoted[i] != '"'; ++i) {
    if (quoted[i] == '\\' && i + 1 < quoted.size()) ++i;
    path += quoted[i];
  }
  const fs::path folder(path);
  return folder.is_absolute() && folder / "" != home / "" ? folder : fs::path();
}

}  // namespace

fs::path configFolder() {
  fs::path own = namedFolder("XDG_CONFIG_HOME");
  if (const auto home = namedFolder("HOME"); own.empty() && !home.empty()) own = home / ".config";
  return own;
}

fs::path userFolder(const std::string& name) {
  if (auto told = namedFolder(name.c_str()); !told.empty()) return told;
  const fs::path config = configFolder();
  if (config.empty()) return {};
  const auto text = readWholeFile((config / "user-dirs.dirs").string(), FileSize::Settings, "there is none");
  if (!text) return {};
  const std::string begin = name + "=\"";
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(begin)) return folderIn(std::string_view(line).substr(begin.size()), namedFolder("HOME"));
  }
  return {};
}

}  // namespace relievo
