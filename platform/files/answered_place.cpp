// SPDX-License-Identifier: Apache-2.0
#include "platform/files/answered_place.h"

#include <cerrno>
#include <filesystem>
#include <optional>

#include "platform/files/file_system_answer.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

FolderEntry::Kind kindOf(const fs::directory_entry& entry) {
  std::error_code unknown;
  if (entry.is_regular_file(unknown)) return FolderEntry::Kind::File;
  return entry.is_directory(unknown) ? FolderEntry::Kind::Folder : FolderEntry::Kind::Other;
}

// An error on the way ends the list.
std::vector<FolderEntry> listNow(const std::string& path) {
  std::vector<FolderEntry> found;
  std::error_code failed;
  fs::directory_iterator entries(path, failed);
  for (; !failed && entries != fs::directory_iterator(); entries.increment(failed)) {
    found.push_back({entries->path().filename().string(), kindOf(*entries)});
  }
  return found;
}

}  // namespace

Result<struct stat> statusOf(const std::string& path) {
  struct Status {
    struct stat status;
    int error;
  };
  if (path.empty()) return fail(ErrorCode::NotFound, "has no name", ENOENT);
  const auto answer = answerOf(path, [path] {
    Status asked{};
    if (::stat(path.c_str(), &asked.status) != 0) asked.error = errno;
    return asked;
  });
  if (!answer) return std::unexpected(answer.error());
  if (answer->error != 0) return fail(ErrorCode::NotFound, "cannot be found; check the path", answer->error);
  return answer->status;
}

bool isThere(const std::string& path) {
  return statusOf(path).has_value();
}
bool isRegularFile(const std::string& path) {
  const auto status = statusOf(path);
  return status && S_ISREG(status->st_mode);
}
bool isFolder(const std::string& path) {
  const auto status = statusOf(path);
  return status && S_ISDIR(status->st_mode);
}

Result<std::vector<FolderEntry>> listFolder(const std::string& path) {
  return answerOf(path, [path] { return listNow(path); });
}
std::vector<FolderEntry> entriesOf(const std::string& path) {
  return listFolder(path).value_or(std::vector<FolderEntry>());
}

Result<void> makeFolders(const std::string& path) {
  const auto failed = answerOf(path, [path] {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    return error.value();
  });
  if (!failed) return std::unexpected(failed.error());
  if (*failed == 0) return {};
  return fail(ErrorCode::Io, "its folder cannot be made; choose another folder", *failed);
}

}  // namespace relievo
