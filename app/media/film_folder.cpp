// SPDX-License-Identifier: Apache-2.0
#include "app/media/film_folder.h"

#include <algorithm>
#include <filesystem>

#include "hal/media_names.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

std::string stemOf(const std::string& name) {
  return name.substr(0, name.rfind('.'));
}

// The film in `names` that holds the depth of `film`; empty if there is none.
std::string depthOf(const std::string& film, const std::vector<std::string>& names) {
  for (const char* mark : {"-depth", "_depth", ".depth"}) {
    const auto found = std::ranges::find(names, stemOf(film) + mark, stemOf);
    if (found != names.end()) return *found;
  }
  return "";
}

}  // namespace

std::optional<std::vector<PlaylistEntry>> filmsIn(const std::string& url) {
  std::error_code failed;
  const fs::path folder(url);
  if (!fs::is_directory(folder, failed) || fs::is_directory(folder / "depth", failed)) return std::nullopt;
  std::vector<std::string> names;
  std::size_t pictures = 0;
  fs::directory_iterator entries(folder, failed);
  for (; !failed && entries != fs::directory_iterator(); entries.increment(failed)) {
    const std::string name = entries->path().filename().string();
    const MediaKind kind = name.starts_with('.') ? MediaKind::Neither : mediaKindOf(name);
    pictures += kind == MediaKind::Picture ? 1 : 0;
    if (kind == MediaKind::Film && names.size() < kMostEntries) names.push_back(name);
  }
  if (!isListOfFilms(names.size(), pictures)) return std::nullopt;
  std::ranges::sort(names, naturalLess);
  std::vector<std::string> depths;
  for (const std::string& name : names) depths.push_back(depthOf(name, names));
  std::vector<PlaylistEntry> films;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::ranges::find(depths, names[i]) != depths.end()) continue;
    films.push_back({.url = folder / names[i],
                     .depth_url = depths[i].empty() ? "" : (folder / depths[i]).string(),
                     .title = stemOf(names[i])});
  }
  return films;
}

}  // namespace relievo
