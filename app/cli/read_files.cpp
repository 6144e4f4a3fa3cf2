// SPDX-License-Identifier: Apache-2.0
#include "app/cli/read_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "app/media/reading/recording_place.h"
#include "app/media/tracks/film_tracks.h"
#include "hal/media/media_names.h"
#include "platform/files/answered_file.h"
#include "platform/files/answered_place.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 4;
constexpr std::size_t kMostFiles = 200'000;

// "picture-%04d.png": the position of the number, and the text before and after it.
struct Numbered {
  std::string before, behind;
};
std::optional<Numbered> numbered(const std::string& name) {
  for (std::size_t at = name.find('%'); at != std::string::npos; at = name.find('%', at + 1)) {
    std::size_t end = at + 1;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0) ++end;
    if (end < name.size() && name[end] == 'd') return Numbered{name.substr(0, at), name.substr(end + 1)};
  }
  return std::nullopt;
}

bool isOf(const Numbered& series, const std::string& name) {
  const std::size_t around = series.before.size() + series.behind.size();
  if (name.size() <= around || !name.starts_with(series.before) || !name.ends_with(series.behind)) return false;
  const std::string_view digits(name.data() + series.before.size(), name.size() - around);
  return std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

fs::path folderOf(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

void addSeries(const fs::path& folder, const Numbered& series, std::vector<std::string>& files) {
  for (const auto& [name, is] : entriesOf(folder)) {
    if (files.size() >= kMostFiles) return;
    if (isOf(series, name)) files.push_back(folder / name);
  }
}

// How a list's text contains the names.
enum class ListKind : std::uint8_t {
  None,
  M3u,       // a name a line; HLS in quotes too, and playlists of films behind a colon
  Ffconcat,  // file NAME
  Dash,      // XML; most segments are named by a pattern
};

// FFmpeg recognises lists by their first bytes, under any name.
ListKind listKindOf(const std::string& path) {
  const std::string ending = endingOf(path);
  if (ending == "m3u" || ending == "m3u8") return ListKind::M3u;
  std::array<std::uint8_t, 4096> bytes{};
  const auto file = AnsweredFile::open(path);
  const std::size_t got = file ? file->read(0, bytes).value_or(0) : 0;
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), got);
  if (head.starts_with("#EXTM3U")) return ListKind::M3u;
  if (head.starts_with("ffconcat version")) return ListKind::Ffconcat;
  return head.find("<MPD") != head.npos ? ListKind::Dash : ListKind::None;
}

std::string withoutBlanksAround(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == text.npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin));
}

// The texts between any two of the characters `around`, and the first and the last.
std::vector<std::string> partsOf(std::string_view line, std::string_view around) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find_first_of(around, at), line.size());
    if (end > at) parts.push_back(withoutBlanksAround(line.substr(at, end - at)));
    at = end + 1;
  }
  return parts;
}

// The names in one line of a list.
std::vector<std::string> namesIn(const std::string& line, ListKind kind) {
  if (kind == ListKind::Dash) return partsOf(line, "<>\"'");
  if (kind == ListKind::Ffconcat) {
    // FFmpeg takes no names here that have quotes and backslashes of their own.
    std::string name = line.starts_with("file") ? line.substr(4) : "";
    std::erase_if(name, [](char c) { return c == '\'' || c == '\\'; });
    return {withoutBlanksAround(name)};
  }
  if (!line.starts_with('#')) return {line};
  std::vector<std::string> names = partsOf(line, "\"");
  if (const std::size_t colon = line.find(':'); colon != line.npos) names.push_back(line.substr(colon + 1));
  return names;
}

void addFiles(const std::string& address, int depth, std::vector<std::string>& files);

// A report or a recording may lie among the films. Of the JSON files, `addBeside` knows the one that is read; of the
// others, Stray Scanner's odometry.csv is read.
bool mayBeOutput(const std::string& name) {
  const std::string ending = endingOf(name);
  return ending == "json" || (ending == "csv" && name != "odometry.csv");
}

// A folder of pictures, and its folders of colour and depth.
void addFolder(const fs::path& folder, int depth, std::vector<std::string>& files) {
  for (const auto& [name, is] : entriesOf(folder)) {
    if (files.size() >= kMostFiles) return;
    if (!mayBeOutput(name)) files.push_back(folder / name);
    if (is == FolderEntry::Kind::Folder && depth == 0) addFolder(folder / name, 1, files);
  }
}

void addListed(const std::string& list, ListKind kind, int depth, std::vector<std::string>& files) {
  const fs::path folder = fs::path(list).parent_path();
  if (kind == ListKind::Dash) addFolder(folderOf(list), 0, files);
  const auto text = readWholeFile(list, FileSize::Recording, "");
  for (const std::string& line : text ? partsOf(*text, "\n") : std::vector<std::string>()) {
    for (const std::string& name : namesIn(line, kind)) {
      const fs::path path(localPathIn(name));
      if (!path.empty()) addFiles((path.is_absolute() ? path : folder / path).string(), depth, files);
    }
  }
}

void addFiles(const std::string& address, int depth, std::vector<std::string>& files) {
  const std::string path = localPathIn(address);
  if (path.empty() || files.size() >= kMostFiles) return;
  if (const auto status = statusOf(path); status && (S_ISREG(status->st_mode) || S_ISDIR(status->st_mode))) {
    files.push_back(path);
    if (depth < 2 && S_ISDIR(status->st_mode)) addFolder(path, depth, files);
    if (depth == kDeepest || !S_ISREG(status->st_mode)) return;
    if (const ListKind kind = listKindOf(path); kind != ListKind::None) addListed(path, kind, depth + 1, files);
    return;
  }
  const fs::path name(path);
  if (name.filename().string().find_first_of("*?") != std::string::npos) addFolder(folderOf(name), 1, files);
  if (const auto series = numbered(name.filename().string())) addSeries(folderOf(name), *series, files);
}

// Adds files that are read with a film because of its name.
void addBeside(const std::string& film, std::vector<std::string>& files) {
  if (film.empty()) return;
  if (const std::string camera = lookAtPlace(film, "").file; !camera.empty()) files.push_back(camera);
  for (const FilmTrack& subtitles : subtitleFilesOf(film)) files.push_back(subtitles.path);
}

}  // namespace

std::string localPathIn(const std::string& address) {
  for (const char* start : {"file://", "file:"}) {
    if (address.starts_with(start)) return address.substr(std::string_view(start).size());
  }
  return address.find("://") == std::string::npos ? address : "";
}

bool isOfFiles(const std::string& address) {
  const std::string path = localPathIn(address);
  const auto status = statusOf(path);
  return !path.empty() && !path.starts_with("v4l2:") &&
         (!status || S_ISREG(status->st_mode) || S_ISDIR(status->st_mode));
}

std::vector<std::string> filesReadBy(const std::string& address) {
  std::vector<std::string> files;
  addFiles(address, 0, files);
  addBeside(localPathIn(address), files);
  return files;
}

}  // namespace relievo
