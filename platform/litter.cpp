// SPDX-License-Identifier: Apache-2.0
// Temporary files: flock tells whether the process that made one is still running.
#include "platform/litter.h"

#include <fcntl.h>
#include <sys/file.h>

#include <filesystem>
#include <system_error>

#include "platform/unique_fd.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".relievo-";

}  // namespace

std::string litterPattern(const std::string& target) {
  return target + kMark + "XXXXXX";
}

void holdLitter(int fd) noexcept {
  static_cast<void>(::flock(fd, LOCK_SH | LOCK_NB));
}

void removeLitter(const std::string& target) noexcept try {
  const fs::path place(target);
  const fs::path folder = place.has_parent_path() ? place.parent_path() : fs::path(".");
  const std::string start = place.filename().string() + kMark;
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
