// SPDX-License-Identifier: Apache-2.0
// Temporary files: flock tells whether the process that made one is still running.
#include "platform/files/litter.h"

#include <fcntl.h>
#include <sys/file.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "platform/unique_fd.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".relievo-tmp-", kRandom = "XXXXXX";
constexpr std::size_t kLongestName = 255;  // NAME_MAX of Linux
constexpr std::size_t kLongestEnd = 16;    // XXXXXX, or what an AtomicFile puts there

// The beginning of the names of a file's litter. A long name is cut, between characters of UTF-8.
std::string beginningOf(const fs::path& target) {
  std::string name = target.filename().string();
  std::size_t most = kLongestName - kMark.size() - kLongestEnd;
  if (name.size() > most) {
    while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xc0) == 0x80) --most;
    name.resize(most);
  }
  return name.append(kMark);
}

// What mkstemp and mkdtemp put in place of XXXXXX, or a process and a number.
bool isEndOfLitter(std::string_view end) {
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto isRandom = [&](char c) { return isDigit(c) || isLetter(c); };
  const auto isNumber = [&](char c) { return isDigit(c) || c == '-'; };
  return (end.size() == kRandom.size() && std::ranges::all_of(end, isRandom)) ||
         (end.size() <= kLongestEnd && end.contains('-') && std::ranges::all_of(end, isNumber));
}

// Whether `place` is a file, or a folder that has nothing but a playlist and folders of segments in it.
bool isMade(const fs::directory_entry& place) {
  std::error_code failed;
  if (!place.is_directory(failed)) return place.is_regular_file(failed);
  const auto isOfFilm = [](const fs::path& file) {
    const std::string ending = file.extension().string();
    return ending == ".m3u8" || ending == ".m4s" || ending == ".mp4" || ending == ".tmp";
  };
  for (auto inside = fs::recursive_directory_iterator(place, failed); !failed && inside != end(inside);
       inside.increment(failed)) {
    if (!inside->is_directory(failed) && !isOfFilm(inside->path())) return false;
  }
  return !failed;
}

}  // namespace

std::string litterPattern(const std::string& target) {
  return target.substr(0, target.rfind('/') + 1) + beginningOf(target) + std::string(kRandom);
}

void holdLitter(int fd) noexcept {
  static_cast<void>(::flock(fd, LOCK_SH | LOCK_NB));
}

void removeLitter(const std::string& target) noexcept try {
  const fs::path place(target);
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  const std::string start = beginningOf(place);
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(start) || !isEndOfLitter(std::string_view(name).substr(start.size()))) continue;
    if (entry.is_symlink(failed) || !isMade(entry)) continue;
    const UniqueFd fd(::open(entry.path().c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC));
    if (fd.valid() && ::flock(fd.get(), LOCK_EX | LOCK_NB) == 0) fs::remove_all(entry.path(), failed);
  }
} catch (const std::exception&) {
  return;  // out of memory: leave the rest
}

}  // namespace relievo
