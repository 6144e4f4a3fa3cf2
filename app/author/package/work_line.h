// SPDX-License-Identifier: Apache-2.0
// A thread that does jobs one after the other, so that the stages of the packager work at the same time.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace relievo {

// `Answer` is an std::expected<void, ..>. The queue is short: `add` blocks while it is full, so that fast stages do not
// fill the memory with pictures. After the first failure no further job runs. Call `add` and `finish` from one thread.
// The destructor drops the waiting jobs and waits for the present one.
template <class Answer>
class WorkLine {
 public:
  using Job = std::move_only_function<Answer()>;
  static constexpr std::size_t kWaiting = 1;
  // How many buffers the owner needs: for the waiting jobs, for the present one, and for the next.
  static constexpr std::size_t kBuffers = kWaiting + 2;

  WorkLine() : thread_([this](const std::stop_token& stop) { work(stop); }) {}

  // Queues a job. After a failure of an earlier job, returns that failure and takes no job.
  [[nodiscard]] Answer add(Job job) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !answer_ || jobs_.size() < kWaiting; });
    if (!answer_) return answer_;
    jobs_.push_back(std::move(job));
    changed_.notify_all();
    return {};
  }
  // Waits until every job is done.
  [[nodiscard]] Answer finish() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !answer_ || (jobs_.empty() && !busy_); });
    return answer_;
  }

 private:
  void work(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [this] { return answer_ && !jobs_.empty(); })) {
      if (stop.stop_requested()) return;
      Job job = std::move(jobs_.front());
      jobs_.pop_front();
      busy_ = true;
      changed_.notify_all();
      lock.unlock();
      Answer answer = job();
      job = nullptr;
      lock.lock();
      busy_ = false;
      if (!answer) answer_ = std::move(answer);
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Job> jobs_;  // waiting
  bool busy_ = false;
  Answer answer_;        // the first failure
  std::jthread thread_;  // the last member: it ends before the others
};

}  // namespace relievo
