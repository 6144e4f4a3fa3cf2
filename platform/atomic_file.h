// SPDX-License-Identifier: Apache-2.0
// A file that appears whole or not at all: written unnamed or under a temporary name, and put in place when done.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "platform/error.h"
#include "platform/files/answered_output.h"

namespace relievo {

enum class Existing : std::uint8_t {
  Replace,
  Keep,    // if the file exists at the commit, the commit fails: the first of several writers wins
  Beside,  // if the file exists at the commit, this one is put beside it: "run-2.json" beside "run.json"
};

// Where a file that is written to `path` is put: links are followed, also one to a file that is not there yet. `path`
// if that cannot be told. Waits for the file system.
[[nodiscard]] std::string placeOf(const std::string& path);

// Not thread-safe. No call waits longer than 10 s for the file system (file_system_answer.h): Timeout. A device or a
// pipe is written to directly, since it cannot be replaced; a pipe that nobody reads, a disk and a socket are refused.
// Where the file system supports unnamed files (ext4, xfs, btrfs, tmpfs, ..), nothing is left behind however the
// program ends; elsewhere a killed program leaves its temporary file, which the next `create` for that path removes.
class AtomicFile {
 public:
  AtomicFile() = default;
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();  // without a commit, discards what was written

  // Creates the temporary file, so that an unwritable path is reported before any work is done.
  [[nodiscard]] static Result<AtomicFile> create(const std::string& path, Existing existing = Existing::Replace);

  // Buffered, and written on another thread; `commit` reports a failure.
  void write(std::string_view text);
  // Syncs the file to disk, then puts it in place. Call once.
  [[nodiscard]] Result<void> commit();

  // What the commit does with a file that exists, if that is known only after `create`.
  void setExisting(Existing existing) noexcept { existing_ = existing; }

  // As given; after a commit beside another file, the name that this one has.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  // The file before the commit, for a caller that writes at positions of its own choice instead of through `write`.
  [[nodiscard]] AnsweredOutput& output() noexcept { return output_; }

 private:
  void writeText();
  [[nodiscard]] Result<void> moveIntoPlace();
  void discard() noexcept;

  AnsweredOutput output_;
  std::string text_;       // not yet written
  std::string path_;       // as given
  std::string target_;     // `path_` with symbolic links resolved
  std::string temporary_;  // empty: `target_` is written directly
  Existing existing_ = Existing::Replace;
  bool nameless_ = false;  // `temporary_` is the open file's path in /proc
  bool answers_ = true;    // false once the file system has not answered in time
};

}  // namespace relievo
