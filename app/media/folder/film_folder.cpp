// SPDX-License-Identifier: Apache-2.0
#include "app/media/folder/film_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string_view>
#include <utility>

#include "app/media/folder/picture_series.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_place.h"
#include "platform/print.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

// Files by their names without ending, in small letters.
using FilesByStem = std::multimap<std::string, std::string>;
FilesByStem byStem(const std::vector<std::string>& names) {
  FilesByStem files;
  for (const std::string& name : names) files.emplace(lowerCase(stemOf(name)), name);
  return files;
}

// "a" of "a_src" and "a_input", as Video Depth Anything and DepthCrafter name the film that their depth is of.
std::string baseOfSource(const std::string& stem) {
  return stem.ends_with("_src") || stem.ends_with("_input") ? stem.substr(0, stem.rfind('_')) : "";
}

// Names that the depth of a film of this name may have, the usual ones first: "a-depth" for "a", "depth_a" for
// "color_a".
std::vector<std::string> depthStems(const std::string& stem) {
  std::vector<std::string> stems;
  for (const std::string_view word_for_depth : kDepthWords) {
    const std::string depth(word_for_depth);
    for (const char* const between : {"-", "_", "."})
      stems.push_back(print("%s%s%s", stem.c_str(), between, depth.c_str()));
    for (const std::string word : {"color", "colour", "rgb", "image", "left"}) {
      const std::size_t at = stem.find(word);
      if (at != stem.npos) stems.push_back(std::string(stem).replace(at, word.size(), depth));
    }
    for (const char* const between : {"-", "_"}) stems.push_back(print("%s%s%s", depth.c_str(), between, stem.c_str()));
  }
  if (const std::string base = baseOfSource(stem); !base.empty())
    stems.insert(stems.end(), {base + "_depths", base + "_depth", base + "_vis"});
  return stems;
}

// Of "_video_depth" and "_depth_vis": depth, and words that programs which guess it put beside it. Other words belong
// to another film: "-2_depth", " - In Depth".
bool isOfDepth(std::string_view rest) {
  static constexpr std::array<std::string_view, 8> kBeside{"video", "vis", "map", "pred", "raw", "gray", "grey", "out"};
  bool says_depth = false;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find_first_of("-_. "), rest.size());
    const std::string_view word = rest.substr(0, end);
    const bool is_depth = std::ranges::find(kDepthWords, word) != kDepthWords.end();
    says_depth = says_depth || is_depth;
    if (!word.empty() && !is_depth && std::ranges::find(kBeside, word) == kBeside.end()) return false;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return says_depth;
}

// The file that holds the depth of `film`; empty if there is none.
std::string depthOf(const std::string& film, const FilesByStem& files) {
  const std::string stem = lowerCase(stemOf(film));
  const auto [same, end] = files.equal_range(baseOfSource(stem));  // DepthCrafter's "a.npz" for "a_input.mp4"
  const auto numbers = std::find_if(same, end, [](const auto& file) { return endingOf(file.second) == "npz"; });
  if (numbers != end) return numbers->second;
  for (const std::string& wanted : depthStems(stem)) {
    if (const auto found = files.lower_bound(wanted); found != files.end() && found->first == wanted)
      return found->second;
  }
  if (saysDepth(film)) return "";
  for (auto at = files.upper_bound(stem); at != files.end() && at->first.starts_with(stem); ++at) {
    const std::string_view rest = std::string_view(at->first).substr(stem.size());
    const bool is_apart = std::isalnum(static_cast<unsigned char>(rest.front())) == 0;
    if (is_apart && isOfDepth(rest)) return at->second;
  }
  return "";
}

// The file of numbers of a picture's own name: "IMG_1.npy" for "IMG_1.jpg", those that hold nothing else first.
std::string twinOf(const std::string& picture, const FilesByStem& files) {
  const auto [begin, end] = files.equal_range(lowerCase(stemOf(picture)));
  for (const std::string_view ending : {"pfm", "dpt", "npy", "npz", "exr", "tif", "tiff", "png"}) {
    const auto is = [&](const auto& file) { return file.second != picture && endingOf(file.second) == ending; };
    if (const auto twin = std::find_if(begin, end, is); twin != end) return twin->second;
  }
  return "";
}

// The part of a pattern of pictures' names that stands for their numbers; empty for the name of a file.
std::string numberIn(const std::string& name) {
  const std::size_t star = name.find('*'), percent = name.find('%');
  if (star != name.npos) return "*";
  const std::size_t end = percent == name.npos ? name.npos : name.find_first_not_of("0123456789", percent + 1);
  return end != name.npos && name[end] == 'd' ? name.substr(percent, end + 1 - percent) : "";
}

// The name with its last number replaced.
std::string numbered(const std::string& name, const std::string& number) {
  const std::size_t last = stemOf(name).find_last_of("0123456789");
  if (last == name.npos) return name;
  const std::size_t begin = name.find_last_not_of("0123456789", last) + 1;
  return name.substr(0, begin) + number + name.substr(last + 1);
}

bool isOneOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::ranges::find(words, word) != words.end();
}

// A camera's picture, or one made for the eye.
bool mayBePhoto(const std::string& name) {
  return isPhotoName(name) || isOneOf(endingOf(name), {"webp", "avif", "png"});
}

// Films, and files that hold a series of pictures.
bool mayHoldFilm(const std::string& name) {
  const std::string ending = endingOf(name);
  const bool scan = name == "depth.bin";  // ScanNet++
  return scan || mediaKindOf(name) == MediaKind::Film || isOneOf(ending, {"npy", "npz", "tif", "tiff"});
}

// The depth of the only film of a folder: a file that holds it, or the pattern of its pictures; empty if there is none.
std::string depthFileOf(const std::string& film, std::vector<std::string> files, const fs::path& place) {
  std::vector<std::string> pictures;
  for (const std::string& name : files) {
    if (mediaKindOf(name) == MediaKind::Picture && saysDepth(name)) pictures.push_back(place / name);
  }
  if (const auto series = seriesOf(pictures)) return *series;
  std::erase_if(files, [](const std::string& name) { return !mayHoldFilm(name); });
  const std::string depth = depthOf(film, byStem(files));
  return depth.empty() ? "" : (place / depth).string();
}

std::vector<std::string> picturesOf(const fs::path& folder) {
  std::vector<std::string> pictures;
  for (const FolderEntry& entry : entriesOf(folder)) {
    if (mediaKindOf(entry.name) == MediaKind::Picture) pictures.push_back(entry.name);
  }
  return pictures;
}

// Arrays of cameras, not of pictures: "poses_bounds.npy", "intrinsics.npy", "K.npy".
bool isOfCameras(const std::string& name) {
  const std::string stem = lowerCase(stemOf(name));
  static constexpr std::array<std::string_view, 9> kParts{"pose",      "intrinsic", "extrinsic", "cameras", "bounds",
                                                          "timestamp", "calib",     "c2w",       "w2c"};
  const auto isIn = [&](std::string_view part) { return stem.find(part) != stem.npos; };
  return !saysDepth(name) && (stem == "k" || stem == "cam" || stem == "cams" || std::ranges::any_of(kParts, isIn));
}

// The only array among the pictures of `folder`; empty if it is the depth of one of the pictures `beside`, or if one of
// them says that it is depth and the array does not.
std::string arrayAmong(const std::vector<std::string>& pictures, const fs::path& folder,
                       const std::vector<std::string>& beside) {
  const auto isArray = [](const std::string& name) {
    return (endingOf(name) == "npy" && !isOfCameras(name)) || (endingOf(name) == "npz" && saysDepth(name));
  };
  const auto array = std::ranges::find_if(pictures, isArray);
  if (std::ranges::count_if(pictures, isArray) != 1) return "";
  const bool of_one = std::ranges::any_of(beside, [&](const std::string& name) {
    return name != *array &&
           ((saysDepth(name) && !saysDepth(*array)) || lowerCase(stemOf(name)) == lowerCase(stemOf(*array)) ||
            !depthOf(name, byStem({*array})).empty());
  });
  return of_one ? "" : (folder / *array).string();
}

// Colour pictures, in `place` or its folder `color`, and the array of their depths, in `place` or its folder `depth`.
std::optional<FilmOverDepth> picturesOverArray(const fs::path& place, const std::string& color,
                                               const std::string& depth) {
  std::vector<std::string> pictures = picturesOf(place / color);
  const std::vector<std::string> depths = picturesOf(place / depth);
  FilmOverDepth found{.film = (place / color).string(), .depth = arrayAmong(depths, place / depth, pictures)};
  if (found.depth.empty() || (!depth.empty() && depths.size() > 1)) return std::nullopt;
  std::erase_if(pictures, [](const std::string& name) { return isOneOf(endingOf(name), {"npy", "npz"}); });
  if (pictures.size() < 2) return std::nullopt;
  if (!color.empty()) return found;
  for (std::string& name : pictures) name = place / name;
  const auto series = seriesOf(pictures);
  if (series) found.film = *series;
  return series ? std::optional(found) : std::nullopt;
}

}  // namespace

std::optional<FilmOverDepth> filmOverDepth(const std::string& folder) {
  if (!isFolder(folder)) return std::nullopt;
  const fs::path place(folder);
  std::vector<std::string> films, files;
  std::string color, depth;
  for (const auto& [name, is] : entriesOf(folder)) {
    if (is == FolderEntry::Kind::File) files.push_back(name);
    if (is == FolderEntry::Kind::File && mediaKindOf(name) == MediaKind::Film && !saysDepth(name))
      films.push_back(name);
    if (is != FolderEntry::Kind::Folder || picturesOf(place / name).empty()) continue;
    if (isOneOf(name, {"rgb", "color", "colour", "image", "images"})) color = name;
    if (isOneOf(name, {"depth", "depths", "depth_images", "disp", "disparity", "dpt", "D"})) depth = name;
  }
  if (films.empty()) return picturesOverArray(place, color, depth);
  if (!color.empty()) return std::nullopt;
  const auto isColor = [](const std::string& name) {
    return isOneOf(std::string(stemOf(name)), {"rgb", "color", "colour", "video", "image"});
  };
  const auto film = films.size() == 1 ? films.begin() : std::ranges::find_if(films, isColor);
  if (film == films.end()) return std::nullopt;
  FilmOverDepth found{.film = place / *film, .depth = ""};
  if (!depth.empty()) {
    const std::vector<std::string> pictures = picturesOf(place / depth);
    const std::string array = pictures.size() == 1 ? arrayAmong(pictures, place / depth, {}) : "";
    found.depth = array.empty() ? (place / depth).string() : array;
  } else if (films.size() == 1) {
    found.depth = depthFileOf(*film, files, place);
  }
  return found.depth.empty() ? std::nullopt : std::optional(found);
}

std::vector<PlaylistEntry> pairedFilms(const std::string& folder, std::vector<std::string> names) {
  std::ranges::sort(names, naturalLess);
  std::vector<std::string> depths;
  depths.reserve(names.size());
  const FilesByStem files = byStem(names);
  for (const std::string& name : names) depths.push_back(depthOf(name, files));
  const fs::path place(folder);
  std::vector<PlaylistEntry> films;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::ranges::find(depths, names[i]) != depths.end()) continue;
    films.push_back({.url = place / names[i],
                     .depth_url = depths[i].empty() ? "" : (place / depths[i]).string(),
                     .title = std::string(stemOf(names[i]))});
  }
  return films;
}

std::optional<std::vector<PlaylistEntry>> filmsIn(const std::string& url) {
  const fs::path folder(url);
  if (!isFolder(folder) || isFolder(folder / "depth") || filmOverDepth(url)) return std::nullopt;
  std::vector<std::string> names;
  std::size_t pictures = 0;
  for (const auto& [name, is] : entriesOf(folder)) {
    const MediaKind kind = name.starts_with('.') ? MediaKind::Neither : mediaKindOf(name);
    pictures += kind == MediaKind::Picture && endingOf(name) != "npz" ? 1 : 0;  // an archive is often something else
    if (kind == MediaKind::Film && names.size() < kMostEntries) names.push_back(name);
  }
  if (!isListOfFilms(names.size(), pictures)) return std::nullopt;
  return pairedFilms(url, std::move(names));
}

std::string depthBeside(const std::string& film) {
  const fs::path path(film);
  const MediaKind kind = mediaKindOf(film);
  const std::string number = kind == MediaKind::Picture ? numberIn(path.filename().string()) : "";
  if (kind == MediaKind::Neither || (number.empty() && !isRegularFile(path))) return "";
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::vector<std::string> names;
  for (const auto& [name, is] : entriesOf(folder)) {
    const bool fits = kind == MediaKind::Film ? mayHoldFilm(name) : mediaKindOf(name) == kind;
    if (fits && is == FolderEntry::Kind::File) names.push_back(number.empty() ? name : numbered(name, number));
  }
  std::string depth = depthOf(path.filename().string(), byStem(names));
  if (depth.empty() && number.empty() && mayBePhoto(film)) depth = twinOf(path.filename().string(), byStem(names));
  if (depth.empty() && kind == MediaKind::Film) {
    const auto pair = filmOverDepth(folder);
    return pair && fs::path(pair->film).filename() == path.filename() ? pair->depth : "";
  }
  return depth.empty() ? "" : (path.has_parent_path() ? folder / depth : fs::path(depth)).string();
}

std::string photoBeside(const std::string& depth) {
  if (!isOneOf(endingOf(depth), {"pfm", "dpt", "npy", "npz"}) || !isRegularFile(depth)) return "";
  const std::string stem(depth.substr(0, depth.rfind('.') + 1));
  for (const char* const ending : {"jpg", "jpeg", "JPG", "JPEG", "heic", "HEIC"}) {
    if (isRegularFile(stem + ending)) return stem + ending;
  }
  return "";
}

}  // namespace relievo
