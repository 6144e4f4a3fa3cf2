// SPDX-License-Identifier: Apache-2.0
#include "platform/files/move.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "platform/unique_fd.h"

namespace relievo {
namespace {

// 0 or errno.
int renamed(const std::string& from, const std::string& to, unsigned flags) noexcept {
  return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0 ? 0 : errno;
}

bool refusesFlags(int os_error) noexcept {
  return os_error == EINVAL || os_error == ENOSYS;
}

// Takes the name by something empty of the same kind, which a rename replaces. 0 or errno.
int claim(const std::string& name, bool folder) noexcept {
  if (folder) return ::mkdir(name.c_str(), 0700) == 0 ? 0 : errno;
  const UniqueFd file(::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600));
  return file.valid() ? 0 : errno;
}

}  // namespace

int moveToNew(const std::string& from, const std::string& to) noexcept {
  const int moved = renamed(from, to, RENAME_NOREPLACE);
  if (!refusesFlags(moved)) return moved;
  struct stat file{};
  if (::lstat(from.c_str(), &file) != 0) return errno;
  const bool folder = S_ISDIR(file.st_mode);
  if (!folder && ::link(from.c_str(), to.c_str()) == 0) return ::unlink(from.c_str()) == 0 ? 0 : errno;
  if (!folder && errno == EEXIST) return EEXIST;
  if (const int taken = claim(to, folder); taken != 0) return taken;
  const int failed = renamed(from, to, 0);
  if (failed != 0) std::remove(to.c_str());
  return failed;
}

int exchange(const std::string& from, const std::string& to) {
  const int moved = renamed(from, to, RENAME_EXCHANGE);
  if (!refusesFlags(moved)) return moved;
  const std::string aside = to + ".relievo-old";
  if (const int failed = moveToNew(to, aside); failed != 0) return failed;
  int failed = renamed(from, to, 0);
  if (failed == 0) {
    failed = renamed(aside, from, 0);
    if (failed == 0) return 0;
    std::rename(to.c_str(), from.c_str());
  }
  std::rename(aside.c_str(), to.c_str());
  return failed;
}

}  // namespace relievo
