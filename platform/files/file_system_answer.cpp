// SPDX-License-Identifier: Apache-2.0
// A few threads that take questions from a queue. One that hangs in the kernel is left there, and another is started.
#include "platform/files/file_system_answer.h"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

namespace relievo {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostThreads = 64;
constexpr auto kLook = std::chrono::milliseconds(10);    // between looks at the flag of CancelsAnswers
constexpr auto kGrace = std::chrono::milliseconds(100);  // in which a file system that works answers

thread_local const std::atomic<bool>* cancels = nullptr;
thread_local bool cancelled_before = false;  // the flag has ended a question, and is still set

std::string fullPath(const std::string& path) {
  std::error_code failed;
  const fs::path full = fs::absolute(path, failed);
  return failed ? path : full.lexically_normal().string();
}

bool isIn(std::string_view path, std::string_view place) {
  return path.starts_with(place) && (path.size() == place.size() || path[place.size()] == '/' || place == "/");
}

// As the kernel writes it: "\040" is a blank.
std::string withoutEscapes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escaped = text[i] == '\\' && i + 3 < text.size();
    plain +=
        escaped ? static_cast<char>((text[i + 1] - '0') * 64 + (text[i + 2] - '0') * 8 + text[i + 3] - '0') : text[i];
    if (escaped) i += 3;
  }
  return plain;
}

// The mount that holds the full path, or the path alone if that is the root.
std::string placeOf(const std::string& path) {
  std::string longest;
  std::ifstream mounts("/proc/self/mountinfo");  // proc(5)
  for (std::string line; std::getline(mounts, line);) {
    std::istringstream words(line);
    std::string word;
    for (int field = 0; field < 5; ++field) words >> word;
    const std::string mount = withoutEscapes(word);
    if (mount.size() > longest.size() && isIn(path, mount)) longest = mount;
  }
  return longest.size() > 1 ? longest : path;
}

// Blocks signals in helper threads: the program's own threads handle them.
class SignalsBlocked {
 public:
  SignalsBlocked() noexcept {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

struct Task {
  std::function<void()> question;
  bool done = false;
  std::string stuck_at;  // the place that it waits for beyond the patience
};

}  // namespace

struct FileSystemAnswers::Shared {
  explicit Shared(Duration limit) : patience(limit) {}

  const Duration patience;
  std::mutex mutex;  // guards what follows; not held while a question runs
  std::condition_variable asked, answered;
  std::deque<std::shared_ptr<Task>> queue;
  std::vector<std::shared_ptr<Task>> stuck;
  std::size_t threads = 0, idle = 0;
  bool closed = false;

  [[nodiscard]] bool isStuck(const std::string& path) const {
    return std::ranges::any_of(stuck, [&](const auto& task) { return isIn(path, task->stuck_at); });
  }

  static Result<void> addThread(const std::shared_ptr<Shared>& self) try {
    if (self->threads == kMostThreads) return std::unexpected(kNoAnswer);
    const SignalsBlocked blocked;
    std::thread([self] { serve(*self); }).detach();
    ++self->threads;
    ++self->idle;
    return {};
  } catch (const std::system_error& error) {
    return fail(ErrorCode::Exhausted, kProcessLimit, error.code().value());
  }

  // Fails if all threads are busy, and no other one can be started.
  static Result<void> give(const std::shared_ptr<Shared>& self, std::shared_ptr<Task> task) {
    const bool one_free = self->idle > self->queue.size();
    if (auto added = one_free ? Result<void>() : addThread(self); !added) return added;
    self->queue.push_back(std::move(task));
    self->asked.notify_one();
    return {};
  }

  static void serve(Shared& self) {
    std::unique_lock lock(self.mutex);
    for (;;) {
      self.asked.wait(lock, [&] { return self.closed || !self.queue.empty(); });
      if (self.queue.empty()) return;
      const std::shared_ptr<Task> task = std::move(self.queue.front());
      self.queue.pop_front();
      --self.idle;
      lock.unlock();
      task->question();
      task->question = nullptr;  // what it owns may ask again: not under the lock
      lock.lock();
      ++self.idle;
      task->done = true;
      std::erase(self.stuck, task);
      self.answered.notify_all();
    }
  }

  // Whether the answer has come. Looks at the caller's flag from time to time.
  [[nodiscard]] bool wait(std::unique_lock<std::mutex>& lock, const Task& task) {
    const auto begun = std::chrono::steady_clock::now(), until = begun + patience;
    const std::atomic<bool>* const flag = cancels;
    cancelled_before = cancelled_before && flag != nullptr && *flag;
    while (!task.done && std::chrono::steady_clock::now() < until) {
      const bool in_grace = !cancelled_before && std::chrono::steady_clock::now() < begun + kGrace;
      if (flag != nullptr && *flag && !in_grace) break;
      answered.wait_until(lock, flag == nullptr ? until : std::min(until, std::chrono::steady_clock::now() + kLook));
    }
    return task.done;
  }
};

FileSystemAnswers::FileSystemAnswers(Duration patience) : shared_(std::make_shared<Shared>(patience)) {}

FileSystemAnswers::~FileSystemAnswers() {
  const std::scoped_lock lock(shared_->mutex);
  shared_->closed = true;
  shared_->asked.notify_all();
}

Result<void> FileSystemAnswers::ask(const std::string& path, std::function<void()> question) {
  auto task = std::make_shared<Task>();
  task->question = std::move(question);
  const std::string full = fullPath(path);
  std::unique_lock lock(shared_->mutex);
  if (shared_->isStuck(full)) return std::unexpected(kNoAnswer);
  if (auto given = Shared::give(shared_, task); !given) return given;
  if (shared_->wait(lock, *task)) return {};
  if (cancels != nullptr && *cancels) {
    cancelled_before = true;
    return std::unexpected(kInterrupted);
  }
  lock.unlock();
  std::string place = placeOf(full);
  lock.lock();
  if (task->done) return {};
  task->stuck_at = std::move(place);
  shared_->stuck.push_back(std::move(task));
  return std::unexpected(kNoAnswer);
}

std::shared_ptr<void> FileSystemAnswers::leave(std::function<void()> act) {
  auto task = std::make_shared<Task>();
  task->question = std::move(act);
  const std::scoped_lock lock(shared_->mutex);
  if (!Shared::give(shared_, task)) shared_->queue.push_back(task);
  return task;
}

void FileSystemAnswers::giveUp(const std::string& path, const std::shared_ptr<void>& act) {
  std::string place = placeOf(fullPath(path));
  const std::scoped_lock lock(shared_->mutex);
  auto task = std::static_pointer_cast<Task>(act);
  if (task->done) return;
  task->stuck_at = std::move(place);
  shared_->stuck.push_back(std::move(task));
}

FileSystemAnswers& fileSystem() {
  static FileSystemAnswers& answers = *new FileSystemAnswers;  // outlives the threads that it leaves behind
  return answers;
}

CancelsAnswers::CancelsAnswers(const std::atomic<bool>* flag) noexcept
    : before_(std::exchange(cancels, flag)), cancelled_before_(std::exchange(cancelled_before, false)) {}

CancelsAnswers::~CancelsAnswers() {
  cancels = before_;
  cancelled_before = cancelled_before_;
}

const std::atomic<bool>* CancelsAnswers::flag() noexcept {
  return cancels;
}

}  // namespace relievo
