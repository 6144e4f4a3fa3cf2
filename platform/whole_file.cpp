// SPDX-License-Identifier: Apache-2.0
// Checks the kind of file before reading, and reads until the end: files of /proc report a size of 0.
#include "platform/whole_file.h"

#include <array>

#include "platform/files/answered_file.h"

namespace relievo {
namespace {

constexpr std::size_t kSettingsBytes = std::size_t{1} << 20, kRecordingBytes = std::size_t{256} << 20;

std::unexpected<Error> tooLarge(FileSize size) noexcept {
  return fail(ErrorCode::Exhausted, size == FileSize::Settings
                                        ? "is larger than the 1 MiB allowed for such a file; name another file"
                                        : "is larger than the 256 MiB allowed for such a file; use a part of it");
}

bool isMissing(const Error& error) noexcept {
  return error.code == ErrorCode::NotFound || error.code == ErrorCode::PermissionDenied;
}

}  // namespace

Result<std::string> readWholeFile(const std::string& path, FileSize size, const char* cannot_read) {
  const auto file = AnsweredFile::open(path);
  if (!file && isMissing(file.error())) return fail(ErrorCode::NotFound, cannot_read, file.error().os_error);
  if (!file) return std::unexpected(file.error());
  if (!file->regular()) return fail(ErrorCode::Unsupported, "is a device or a pipe; name a file");
  const std::size_t most = size == FileSize::Settings ? kSettingsBytes : kRecordingBytes;
  std::string text;
  std::array<std::uint8_t, 65536> part{};
  for (;;) {
    const auto got = file->readSome(text.size(), part);
    if (!got) return std::unexpected(got.error());
    if (*got == 0) return text;
    text.append(reinterpret_cast<const char*>(part.data()), *got);
    if (text.size() > most) return tooLarge(size);
  }
}

}  // namespace relievo
