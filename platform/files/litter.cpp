// SPDX-License-Identifier: Apache-2.0
// Temporary files: flock tells whether the process that made one is still running.
#include "platform/files/litter.h"

#include <fcntl.h>
#include <sys/file.h>

#include <filesystem>
#include <string_view>
#include <system_error>

#include "platform/unique_fd.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".relievo-", kRandom = "XXXXXX";
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
    if (!entry.path().filename().string().starts_with(start)) continue;
    const UniqueFd fd(::open(entry.path().c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC));
    if (fd.valid() && ::flock(fd.get(), LOCK_EX | LOCK_NB) == 0) fs::remove_all(entry.path(), failed);
  }
} catch (const std::exception&) {
  return;  // out of memory: leave the rest
}

}  // namespace relievo
