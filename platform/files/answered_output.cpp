// SPDX-License-Identifier: Apache-2.0
#include "platform/files/answered_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include "platform/clock.h"
#include "platform/files/file_system_answer.h"

namespace relievo {
namespace {

constexpr std::size_t kMostWaiting = std::size_t{8} << 20;  // bytes on their way to the kernel
constexpr std::size_t kAtOnce = std::size_t{1} << 20;       // bytes of one system call
constexpr std::uint64_t kSyncedAtOnce = std::uint64_t{4} << 20;
constexpr auto kLook = std::chrono::milliseconds(10);    // between looks at the flag
constexpr auto kGrace = std::chrono::milliseconds(100);  // after the flag was set
constexpr Error kNotRead{ErrorCode::Timeout, 0, "nobody reads what is written to it for 10 s; check the reader"};
constexpr const char* kFailed = "could not be written completely; is the disk full?";

struct Part {
  std::uint64_t offset;
  std::vector<std::uint8_t> bytes;
};

// 0 or errno.
int writeNow(int fd, const Part& part, bool seekable) {
  std::size_t done = 0;
  while (done < part.bytes.size()) {
    const std::size_t most = part.bytes.size() - done;
    const ssize_t wrote = seekable
                              ? ::pwrite(fd, part.bytes.data() + done, most, static_cast<off_t>(part.offset + done))
                              : ::write(fd, part.bytes.data() + done, most);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return wrote < 0 ? errno : EIO;
    done += static_cast<std::size_t>(wrote);
  }
  return 0;
}

// 0 or errno. File systems without such calls, and pipes, have nothing to wait for.
int syncNow(int fd, std::uint64_t offset, std::uint64_t bytes) {
  constexpr unsigned kAll = SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER;
  const int result =
      bytes == 0 ? ::fsync(fd) : ::sync_file_range(fd, static_cast<off_t>(offset), static_cast<off_t>(bytes), kAll);
  const bool none = errno == ENOSYS || errno == EINVAL || errno == ESPIPE || errno == EOPNOTSUPP || errno == EROFS;
  return result == 0 || none ? 0 : errno;
}

}  // namespace

struct AnsweredOutput::State {
  State(UniqueFd file, std::string name)
      : fd(std::move(file)), path(std::move(name)), seekable(::lseek(fd.get(), 0, SEEK_CUR) >= 0) {}
  ~State() {
    fileSystem().leave([fd = fd.release()] { ::close(fd); });
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  UniqueFd fd;
  const std::string path;
  const bool seekable;
  std::uint64_t end = 0;                         // of the caller's thread
  const std::atomic<bool>* cancelled = nullptr;  // of the caller's thread

  std::mutex mutex;  // guards what follows; not held during a system call
  std::condition_variable progress;
  std::deque<Part> parts;
  std::size_t waiting = 0;  // bytes of the parts, and of the one that is being written
  bool busy = false;        // a helper thread has the file
  MonotonicTime since;      // it began with the present part
  std::shared_ptr<void> helper;
  std::optional<Error> error;

  static MonotonicTime now() { return MonotonicClock().now(); }

  // On a helper thread.
  void writeParts() {
    std::unique_lock lock(mutex);
    while (!parts.empty() && !error) {
      const Part part = std::move(parts.front());
      parts.pop_front();
      since = now();
      lock.unlock();
      const int os_error = writeNow(fd.get(), part, seekable);
      lock.lock();
      waiting -= part.bytes.size();
      if (os_error != 0 && !error) error = Error{ErrorCode::Io, os_error, kFailed};
      progress.notify_all();
    }
    busy = false;
    progress.notify_all();
  }

  void stop(const Error& why) {
    error = why;
    for (const Part& part : parts) waiting -= part.bytes.size();
    parts.clear();
  }

  // Notes a wait that has lasted too long.
  void look() {
    if (!busy || error || now() - since < kAnswerPatience) return;
    stop(seekable ? kNoAnswer : kNotRead);
    if (seekable) fileSystem().giveUp(path, helper);  // a pipe tells nothing about its mount
  }

  // Until no more than so many bytes are on their way.
  void waitFor(std::unique_lock<std::mutex>& lock, std::size_t most) {
    std::optional<MonotonicTime> cancelled_at;
    for (look(); !error && (waiting > most || (most == 0 && busy)); look()) {
      if (cancelled != nullptr && *cancelled) {
        if (!cancelled_at) cancelled_at = now();
        if (now() - *cancelled_at >= kGrace) return stop(kInterrupted);
      }
      progress.wait_for(lock, kLook);
    }
  }

  [[nodiscard]] Result<void> outcome() const {
    if (error) return std::unexpected(*error);
    return {};
  }
};

AnsweredOutput::AnsweredOutput(UniqueFd fd, std::string path)
    : state_(std::make_shared<State>(std::move(fd), std::move(path))) {}

void AnsweredOutput::cancelBy(const std::atomic<bool>* flag) noexcept {
  state_->cancelled = flag;
}

const std::atomic<bool>* AnsweredOutput::cancelFlag() const noexcept {
  return state_->cancelled;
}

Result<void> AnsweredOutput::write(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
  std::unique_lock lock(state_->mutex);
  for (std::size_t at = 0; at < bytes.size(); at += kAtOnce) {
    state_->waitFor(lock, kMostWaiting);
    if (state_->error) return std::unexpected(*state_->error);
    const auto part = bytes.subspan(at, std::min(kAtOnce, bytes.size() - at));
    state_->parts.push_back({offset + at, {part.begin(), part.end()}});
    state_->waiting += part.size();
    state_->end = std::max(state_->end, offset + at + part.size());
    if (std::exchange(state_->busy, true)) continue;
    state_->since = State::now();
    state_->helper = fileSystem().leave([state = state_] { state->writeParts(); });
  }
  return state_->outcome();
}

Result<void> AnsweredOutput::flush() {
  std::unique_lock lock(state_->mutex);
  state_->waitFor(lock, 0);
  return state_->outcome();
}

// Syncs in pieces, so that a large film on a slow disk does not time out.
Result<void> AnsweredOutput::sync() {
  if (auto flushed = flush(); !flushed) return flushed;
  const CancelsAnswers cancels(state_->cancelled);
  for (std::uint64_t at = 0;; at += kSyncedAtOnce) {
    const std::uint64_t piece = at < state_->end ? std::min(kSyncedAtOnce, state_->end - at) : 0;  // 0: all the rest
    const auto synced =
        answerOf(state_->path, [state = state_, at, piece] { return syncNow(state->fd.get(), at, piece); });
    const std::scoped_lock lock(state_->mutex);
    if (!synced) state_->error = synced.error();
    if (synced && *synced != 0) state_->error = Error{ErrorCode::Io, *synced, kFailed};
    if (state_->error || piece == 0) return state_->outcome();
  }
}

Result<std::size_t> AnsweredOutput::read(std::uint64_t offset, std::span<std::uint8_t> out) {
  if (auto flushed = flush(); !flushed) return std::unexpected(flushed.error());
  const CancelsAnswers cancels(state_->cancelled);
  const auto part = answerOf(state_->path, [state = state_, offset, most = std::min(out.size(), kAtOnce)] {
    std::vector<std::uint8_t> bytes(most);
    const ssize_t got = ::pread(state->fd.get(), bytes.data(), most, static_cast<off_t>(offset));
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
    return std::pair(std::move(bytes), got < 0 ? errno : 0);
  });
  if (!part) return std::unexpected(part.error());
  if (part->second != 0) return fail(ErrorCode::Io, "what was written cannot be read; check the disk", part->second);
  std::ranges::copy(part->first, out.begin());
  return part->first.size();
}

std::uint64_t AnsweredOutput::bytes() const noexcept {
  return state_->end;
}

std::optional<Error> AnsweredOutput::error() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->error;
}

}  // namespace relievo
