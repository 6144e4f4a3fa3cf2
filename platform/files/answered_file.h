// SPDX-License-Identifier: Apache-2.0
// A file for reading. No call waits longer than 10 s for the file system, whatever its mount does.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "platform/error.h"

namespace relievo {

// What the kernel has in its memory is read at once; all else is asked as file_system_answer.h says. A thread that is
// cancelled (CancelsAnswers) waits 0.1 s in all for what it still reads of a file. Copies share the open file. A file
// that stalls is closed on a helper thread.
class AnsweredFile {
 public:
  AnsweredFile() = default;  // not open

  // Opens a regular file or a disk. NotFound; Unsupported for a folder, and for other devices and pipes, which may
  // never end; else as ask(). The error has errno.
  [[nodiscard]] static Result<AnsweredFile> open(const std::string& path);
  [[nodiscard]] bool valid() const noexcept { return state_ != nullptr; }
  [[nodiscard]] bool regular() const noexcept;

  // As of now; 0 if it is not known.
  [[nodiscard]] Result<std::uint64_t> bytes() const;
  // Reads some bytes, at least one unless the file ends at `offset`: their number.
  [[nodiscard]] Result<std::size_t> readSome(std::uint64_t offset, std::span<std::uint8_t> out) const;
  // Reads until `out` is full or the file ends.
  [[nodiscard]] Result<std::size_t> read(std::uint64_t offset, std::span<std::uint8_t> out) const;
  // The first error of these calls, if there was one: what ends a film that is read from the file. Lost if the disk
  // failed.
  [[nodiscard]] std::optional<Error> failure() const;
  void close() noexcept { state_.reset(); }

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace relievo
