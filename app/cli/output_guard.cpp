// SPDX-License-Identifier: Apache-2.0
#include "app/cli/output_guard.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "platform/files/answered_place.h"
#include "platform/files/file_system_answer.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 4;
constexpr std::size_t kMostFiles = 200'000;

using Inode = std::pair<dev_t, ino_t>;
// Writing to a device or a pipe destroys nothing: several outputs may be /dev/null.
std::optional<Inode> inodeIn(const struct stat& status) {
  if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) return std::nullopt;
  return Inode{status.st_dev, status.st_ino};
}
std::optional<Inode> inodeOf(const std::string& path) {
  const auto status = statusOf(path);
  return status ? inodeIn(*status) : std::nullopt;
}

std::string fullName(const std::string& path) {
  return answerOf(path,
                  [path] {
                    std::error_code failed;
                    const fs::path full = fs::weakly_canonical(fs::absolute(path, failed), failed);
                    return failed ? path : full.string();
                  })
      .value_or(path);
}

// The local path that an address names; empty for other addresses.
std::string pathIn(const std::string& address) {
  for (const char* start : {"file://", "file:"}) {
    if (address.starts_with(start)) return address.substr(std::string_view(start).size());
  }
  return address.find("://") == std::string::npos ? address : "";
}

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

bool isList(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".m3u" || ending == ".m3u8" || ending == ".ffconcat" || ending == ".concat";
}

void addFiles(const std::string& address, int depth, std::vector<std::string>& files);

// Collects the names that a line of a list may contain: the line itself, and text in quotes or after a colon.
void addNamed(std::string line, const fs::path& folder, int depth, std::vector<std::string>& files) {
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.pop_back();
  std::vector<std::string> names;
  if (!line.starts_with('#')) names.push_back(line);
  if (const std::size_t colon = line.find(':'); line.starts_with('#') && colon != std::string::npos) {
    names.push_back(line.substr(colon + 1));
  }
  for (const char quote : {'"', '\''}) {
    const std::size_t begin = line.find(quote), end = line.rfind(quote);
    if (begin != std::string::npos && end > begin) names.push_back(line.substr(begin + 1, end - begin - 1));
  }
  for (const std::string& name : names) {
    const std::string path = pathIn(name);
    if (!path.empty()) addFiles((fs::path(path).is_absolute() ? fs::path(path) : folder / path).string(), depth, files);
  }
}

// A folder of pictures, and its folders of colour and depth.
void addFolder(const fs::path& folder, int depth, std::vector<std::string>& files) {
  for (const auto& [name, is] : entriesOf(folder)) {
    if (files.size() >= kMostFiles) return;
    files.push_back(folder / name);
    if (is == FolderEntry::Kind::Folder && depth == 0) addFolder(folder / name, 1, files);
  }
}

void addFiles(const std::string& address, int depth, std::vector<std::string>& files) {
  const std::string path = pathIn(address);
  if (path.empty() || files.size() >= kMostFiles) return;
  if (inodeOf(path)) {
    files.push_back(path);
    if (depth < 2 && isFolder(path)) addFolder(path, depth, files);
    if (depth == kDeepest || !isList(path)) return;
    const auto text = readWholeFile(path, FileSize::Settings, "");
    for (std::size_t at = 0; text && at < text->size();) {
      const std::size_t end = std::min(text->find('\n', at), text->size());
      addNamed(text->substr(at, end - at), fs::path(path).parent_path(), depth + 1, files);
      at = end + 1;
    }
    return;
  }
  const fs::path name(path);
  if (name.filename().string().find_first_of("*?") != std::string::npos) addFolder(folderOf(name), 1, files);
  if (const auto series = numbered(name.filename().string())) addSeries(folderOf(name), *series, files);
}

std::unexpected<Failure> refuse(const std::string& output, const char* why) {
  return failOn(output, {ErrorCode::InvalidArgument, 0, why});
}

// Of all files that the inputs name.
std::set<Inode> inodesOf(const std::vector<std::string>& inputs) {
  std::set<Inode> inodes;
  for (const std::string& input : inputs) {
    for (const std::string& file : filesReadBy(input)) {
      if (const auto inode = inodeOf(file)) inodes.insert(*inode);
    }
  }
  return inodes;
}

// Whether one of the inputs has the name of this file, which is not there yet. Asks about no other file.
bool isNamed(const std::string& path, const std::vector<std::string>& inputs) {
  return std::ranges::any_of(inputs, [&](const std::string& input) {
    const fs::path named = pathIn(input);
    return !named.empty() && named.filename() == fs::path(path).filename() && fullName(named) == fullName(path);
  });
}

}  // namespace

std::vector<std::string> filesReadBy(const std::string& address) {
  std::vector<std::string> files;
  addFiles(address, 0, files);
  return files;
}

Outcome<void> keepApart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  std::set<Inode> written;
  std::set<std::string> written_names;
  std::optional<std::set<Inode>> read;
  for (const std::string& output : outputs) {
    const std::string path = pathIn(output);
    const auto status = statusOf(path);
    if (!status && status.error().code != ErrorCode::NotFound) return failOn(output, status.error());
    const auto inode = status ? inodeIn(*status) : std::nullopt;
    if (path.empty() || (status && !inode)) continue;
    if (inode && !read) read = inodesOf(inputs);
    const bool is_read = inode ? read->contains(*inode) : isNamed(path, inputs);
    if (is_read) return refuse(output, "is also an input and would be overwritten; choose another file");
    const bool twice = inode ? !written.insert(*inode).second : !written_names.insert(fullName(path)).second;
    if (twice) return refuse(output, "is given for two outputs; choose different files");
  }
  return {};
}

}  // namespace relievo
