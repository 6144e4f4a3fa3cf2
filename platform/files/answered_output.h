// SPDX-License-Identifier: Apache-2.0
// A file for writing. Its bytes go to the kernel on a helper thread: no call waits longer than 10 s for one answer.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo {

// The first error stays, and every later call returns it: Timeout where the file system does not answer, Io with errno,
// or Cancelled. Copies share the file. Use from one thread at a time.
class AnsweredOutput {
 public:
  AnsweredOutput() = default;  // no file
  // `path` identifies the mount. `fd` must not have O_APPEND; a pipe or a device is written in the order of the calls.
  AnsweredOutput(UniqueFd fd, std::string path);
  [[nodiscard]] bool valid() const noexcept { return state_ != nullptr; }

  // Once the flag is set, waiting calls return Cancelled within about 0.1 s. Null: calls cannot be cancelled.
  void cancelBy(const std::atomic<bool>* flag) noexcept;
  [[nodiscard]] const std::atomic<bool>* cancelFlag() const noexcept;

  // Takes a copy. Waits only while 8 MiB are on their way.
  [[nodiscard]] Result<void> write(std::uint64_t offset, std::span<const std::uint8_t> bytes);
  // Waits until the kernel has all that was written.
  [[nodiscard]] Result<void> flush();
  // Waits until the disk has all that was written.
  [[nodiscard]] Result<void> sync();
  // Reads back what was written, until `out` is full or the file ends.
  [[nodiscard]] Result<std::size_t> read(std::uint64_t offset, std::span<std::uint8_t> out);

  [[nodiscard]] std::uint64_t bytes() const noexcept;  // where the farthest write ended
  [[nodiscard]] std::optional<Error> error() const;
  void close() noexcept { state_.reset(); }  // on a helper thread

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace relievo
