// SPDX-License-Identifier: Apache-2.0
// Writes the player's small files (positions, volume, screenshots) on a thread of its own: the film never waits for a
// disk.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "platform/atomic_file.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// `give` and `finish`: from one thread.
class FileWriter {
 public:
  static constexpr std::size_t kMost = 8;                             // waiting, before one without a name
  static constexpr Duration kLastPatience = std::chrono::seconds(2);  // at the end, for all of them
  enum class Where : std::uint8_t { OwnThread, AtOnce };              // AtOnce: within `give`, for simulated time

  explicit FileWriter(Where where = Where::OwnThread, Duration last_patience = kLastPatience);
  ~FileWriter() { finish(); }
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  // Never waits. `write` is called soon, after those queued before it, and reports its own failure. It must own all
  // that it uses, and access the file system only through platform/files, so that it can be cancelled. A waiting write
  // with the same name is replaced, so that there is always room for one; writes with an empty name are not. False
  // after `finish`, or without a name if too many wait.
  bool give(const std::string& name, std::function<void()> write);
  // Waits until all is written, at most for kLastPatience: whatever is not written by then fails with Cancelled.
  void finish();

 private:
  struct Job {
    std::string name;
    std::function<void()> write;
  };
  void threadMain();

  const Duration last_patience_;
  std::atomic<bool> gives_up_ = false;
  std::mutex mutex_;  // of all below
  std::condition_variable wake_;
  std::deque<Job> jobs_;
  bool finishing_ = false, writing_ = false;
  std::thread thread_;
};

// For use in a `write` function: the file appears whole or not at all, and `finish` cancels the waiting.
[[nodiscard]] Result<void> writeFile(const std::string& path, std::string_view text,
                                     Existing existing = Existing::Replace);

}  // namespace relievo
