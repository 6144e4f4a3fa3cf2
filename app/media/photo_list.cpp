// SPDX-License-Identifier: Apache-2.0
#include "app/media/photo_list.h"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <utility>

#include "app/media/folder/film_folder.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_place.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace fs = std::filesystem;

std::optional<std::vector<PlaylistEntry>> photosIn(
    const SourceOptions& options, const std::function<std::unique_ptr<MediaSource>(const std::string&)>& make_source) {
  constexpr std::size_t kOpened = 16;
  const bool is_said = options.packing != Packing::Auto || options.as != nullptr || options.frames_per_s;
  if (is_said || !options.depth_url.empty()) return std::nullopt;
  const std::string& url = options.url;
  const bool is_folder = isFolder(url);
  if (!is_folder && (url.find('*') == url.npos || url.find("://") != url.npos)) return std::nullopt;
  const fs::path folder = is_folder ? fs::path(url) : fs::path(url).parent_path();
  const std::string pattern = is_folder ? "*" : fs::path(url).filename().string();
  std::vector<std::string> photos, names;
  std::set<std::string> stems, films, moving;  // of photos, of films, of photos that move
  for (const auto& [name, is] : entriesOf(folder.empty() ? "." : folder)) {
    const bool fits = is == FolderEntry::Kind::File && mediaKindOf(name) != MediaKind::Neither &&
                      ::fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD) == 0;
    if (fits && names.size() < kMostEntries) names.push_back(name);
    if (fits && isPhotoName(name)) photos.push_back(name);
    if (fits && isPhotoName(name)) stems.insert(lowerCase(stemOf(name)));
    if (fits && mediaKindOf(name) == MediaKind::Film) films.insert(lowerCase(stemOf(name)));
  }
  const auto streamsOf = [&](const std::string& path) {
    const auto source = make_source(path);
    return source->open(path) ? source->streams() : std::vector<StreamInfo>{};
  };
  const auto holdsMore = [&](const std::string& name) {
    return std::ranges::any_of(streamsOf(folder / name), [](const StreamInfo& stream) {
      const auto title = stream.tags.find("TITLE");
      return stream.tags.contains(kViewTag) || stream.tags.contains("STEREO_MODE") ||
             (title != stream.tags.end() && title->second == "depth");
    });
  };
  bool found = false;
  std::ranges::sort(photos, naturalLess);
  for (std::size_t i = 0; i < std::min(photos.size(), kOpened) && !found; ++i) {
    found = holdsMore(photos[i * photos.size() / std::min(photos.size(), kOpened)]);
  }
  if (!found || streamsOf(url).size() > 1) return std::nullopt;
  for (const std::string& name : photos) {
    if (films.contains(lowerCase(stemOf(name))) && holdsMore(name)) moving.insert(lowerCase(stemOf(name)));
  }
  // Films whose pictures are covers.
  if (moving.empty() && std::ranges::includes(stems, films) && filmsIn(url)) return std::nullopt;
  std::erase_if(names, [&](const std::string& name) {
    return mediaKindOf(name) == MediaKind::Film && moving.contains(lowerCase(stemOf(name)));
  });
  return pairedFilms(folder, std::move(names));
}

}  // namespace relievo
