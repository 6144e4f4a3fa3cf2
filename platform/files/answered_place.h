// SPDX-License-Identifier: Apache-2.0
// What is at a path, and in a folder. No call waits longer than 10 s for the file system (file_system_answer.h).
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <string>
#include <vector>

#include "platform/error.h"

namespace relievo {

// stat(2), symbolic links followed. NotFound with errno; else as ask().
[[nodiscard]] Result<struct stat> statusOf(const std::string& path);
// False too if the file system does not answer: the opening that follows then says so at once.
[[nodiscard]] bool isThere(const std::string& path);
[[nodiscard]] bool isRegularFile(const std::string& path);
[[nodiscard]] bool isFolder(const std::string& path);

struct FolderEntry {
  enum class Kind : std::uint8_t { File, Folder, Other };
  std::string name;
  Kind kind = Kind::Other;  // symbolic links followed
};
// In no order, without "." and ".."; empty if the folder cannot be listed. An error as ask().
[[nodiscard]] Result<std::vector<FolderEntry>> listFolder(const std::string& path);
// The same; also empty if the file system does not answer.
[[nodiscard]] std::vector<FolderEntry> entriesOf(const std::string& path);

// Makes the folder and its missing parents.
[[nodiscard]] Result<void> makeFolders(const std::string& path);

}  // namespace relievo
