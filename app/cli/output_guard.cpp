// SPDX-License-Identifier: Apache-2.0
#include "app/cli/output_guard.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "app/cli/read_files.h"
#include "platform/atomic_file.h"
#include "platform/files/answered_place.h"
#include "platform/files/file_system_answer.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

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
                    const fs::path full = fs::weakly_canonical(fs::absolute(placeOf(path), failed), failed);
                    return failed ? path : full.string();
                  })
      .value_or(path);
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

// True if one of the inputs has the name of this file, which does not exist yet.
bool isNamed(const std::string& path, const std::vector<std::string>& inputs) {
  return std::ranges::any_of(inputs, [&](const std::string& input) {
    const fs::path named = localPathIn(input);
    return !named.empty() && named.filename() == fs::path(path).filename() && fullName(named) == fullName(path);
  });
}

}  // namespace

Outcome<void> keepApart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  std::set<Inode> written;
  std::set<std::string> written_names;
  std::optional<std::set<Inode>> read;
  for (const std::string& output : outputs) {
    const std::string path = localPathIn(output);
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
