// SPDX-License-Identifier: Apache-2.0
// A file that appears whole or not at all: written without a name, or beside its place, and put into it when done.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "platform/error.h"

namespace relievo {

enum class Existing : std::uint8_t {
  Replace,
  Keep,  // a file that is there at the commit stays, and the commit fails: of several writers the first one wins
};

// Not thread-safe. A path that is a device or a pipe is written to directly, since it cannot be replaced. Where the
// file system has files without a name (ext4, xfs, btrfs, tmpfs, ..) nothing is left however the program ends;
// elsewhere the temporary file stays when it is killed,
// until the next one of that path is made.
class AtomicFile {
 public:
  AtomicFile() = default;
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();  // without a commit nothing is left

  // Makes the temporary file, so that a path that cannot be written is found out before anything else is done.
  [[nodiscard]] static Result<AtomicFile> create(const std::string& path, Existing existing = Existing::Replace);

  // Buffered; a failure is kept and told by `commit`.
  void write(std::string_view text) noexcept;
  // On the disk, then in its place. Once.
  [[nodiscard]] Result<void> commit();

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  // Where it lies until the commit, for a library that writes files by their names instead of through `write`; it has
  // closed the file before the commit. A path of this process alone.
  [[nodiscard]] const std::string& writtenPath() const noexcept { return temporary_.empty() ? target_ : temporary_; }

 private:
  [[nodiscard]] bool putInPlace();
  void discard() noexcept;

  std::FILE* file_ = nullptr;
  std::string path_;       // as it was given
  std::string target_;     // with links followed
  std::string temporary_;  // empty: written to directly
  Existing existing_ = Existing::Replace;
  bool nameless_ = false;  // `temporary_` is the open file, by /proc
};

}  // namespace relievo
