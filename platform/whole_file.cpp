// SPDX-License-Identifier: Apache-2.0
// Opens without blocking and checks the kind of file before reading.
#include "platform/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr std::size_t kSettingsBytes = std::size_t{1} << 20, kRecordingBytes = std::size_t{256} << 20;

std::unexpected<Error> tooLarge(FileSize size) noexcept {
  return fail(ErrorCode::Exhausted, size == FileSize::Settings
                                        ? "is larger than the 1 MiB allowed for such a file; name another file"
                                        : "is larger than the 256 MiB allowed for such a file; use a part of it");
}

}  // namespace

Result<std::string> readWholeFile(const std::string& path, FileSize size, const char* cannot_read) {
  const UniqueFd fd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (!fd.valid()) return fail(ErrorCode::NotFound, cannot_read, errno);
  struct stat status{};
  if (::fstat(fd.get(), &status) != 0) return fail(ErrorCode::NotFound, cannot_read, errno);
  if (S_ISDIR(status.st_mode)) return fail(ErrorCode::Unsupported, "is a folder; give the name of a file", EISDIR);
  if (!S_ISREG(status.st_mode)) return fail(ErrorCode::Unsupported, "is a device or a pipe; name a file");
  const std::size_t most = size == FileSize::Settings ? kSettingsBytes : kRecordingBytes;
  std::string text;
  std::array<char, 65536> part{};
  for (;;) {  // until the end: files of /proc report a size of 0
    const ssize_t got = ::read(fd.get(), part.data(), part.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(ErrorCode::Io, "reading failed; check the disk", errno);
    if (got == 0) return text;
    text.append(part.data(), static_cast<std::size_t>(got));
    if (text.size() > most) return tooLarge(size);
  }
}

}  // namespace relievo
