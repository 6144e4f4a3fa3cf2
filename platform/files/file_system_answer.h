// SPDX-License-Identifier: Apache-2.0
// Questions to the file system that may never be answered, as on a dead network or FUSE mount: asked on helper threads.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

inline constexpr Duration kAnswerPatience = std::chrono::seconds(10);
inline constexpr Error kNoAnswer{ErrorCode::Timeout, 0, "the file system does not answer within 10 s; check the mount"};
inline constexpr const char* kProcessLimit = "the limit on processes is reached; raise it (ulimit -u) or end some";
inline constexpr Error kInterrupted{ErrorCode::Cancelled, 0, "interrupted while waiting for the file system"};

// A system call on a stalled mount cannot be ended from outside: its thread is given up. The thread goes on when the
// kernel gives it back. Any thread; not real-time.
class FileSystemAnswers {
 public:
  explicit FileSystemAnswers(Duration patience = kAnswerPatience);
  // Threads that still wait for the kernel stay behind.
  ~FileSystemAnswers();
  FileSystemAnswers(const FileSystemAnswers&) = delete;
  FileSystemAnswers& operator=(const FileSystemAnswers&) = delete;

  // Runs `question`, which concerns the file `path`, and waits for its end. Timeout after the patience, or at once
  // while an earlier question about the same mount is still unanswered after that time; Cancelled (CancelsAnswers);
  // Exhausted if no thread can be started: then `question` does not run.
  // After an error `question` may still run, now or later: it must own all that it uses.
  [[nodiscard]] Result<void> ask(const std::string& path, std::function<void()> question);
  // Starts `act`, such as a close, without waiting for it; later if all threads are busy. The result can be passed to
  // `giveUp`.
  std::shared_ptr<void> leave(std::function<void()> act);
  // Until `act` ends, which `leave` has started, questions about the mount of `path` fail at once.
  void giveUp(const std::string& path, const std::shared_ptr<void>& act);

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

// The program's own, with the patience of 10 s. It is never destroyed.
[[nodiscard]] FileSystemAnswers& fileSystem();

// While this lives, questions of the thread that made it end with Cancelled soon after the flag is set, unless they are
// answered within 0.1 s. The flag must outlive it.
class CancelsAnswers {
 public:
  explicit CancelsAnswers(const std::atomic<bool>& flag) noexcept : CancelsAnswers(&flag) {}
  // Null: none is cancelled.
  explicit CancelsAnswers(const std::atomic<bool>* flag) noexcept;
  ~CancelsAnswers();
  CancelsAnswers(const CancelsAnswers&) = delete;
  CancelsAnswers& operator=(const CancelsAnswers&) = delete;

  // Of this thread; null if nothing cancels.
  [[nodiscard]] static const std::atomic<bool>* flag() noexcept;

 private:
  const std::atomic<bool>* before_;
  bool cancelled_before_;
};

// What `question` returns. It must own all that it uses.
template <class Question>
[[nodiscard]] auto answerOf(const std::string& path, Question question, FileSystemAnswers& answers = fileSystem())
    -> Result<decltype(question())> {
  auto answer = std::make_shared<std::optional<decltype(question())>>();
  const auto asked = answers.ask(path, [answer, question = std::move(question)] { answer->emplace(question()); });
  if (!asked) return std::unexpected(asked.error());
  return std::move(**answer);
}

}  // namespace relievo
