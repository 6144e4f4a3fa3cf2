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

// `Answer` is an std::expected<void, ..>. Few jobs wait: `add` blocks while the line is full, so that fast stages do
// not fill the memory with pictures. After the first failure no job is done any more. `add` and `finish` from one
// thread. Destroying it abandons the jobs that wait and lets the present one end.
template <class Answer>
class WorkLine {
 public:
  using Job = std::move_only_function<Answer()>;
  static constexpr std::size_t kWaiting = 1;
  // How many buffers the owner needs: for the jobs that wait, for the present one, and for the next.
  static constexpr std::size_t kBuffers = kWaiting + 2;

  WorkLine() : thread_([this](const std::stop_token& stop) { work(stop); }) {}

  // The failure of an earlier job, if one has failed; the new one is then not taken.
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
  std::deque<Job> jobs_;  // that wait
  bool busy_ = false;
  Answer answer_;        // the first failure
  std::jthread thread_;  // the last member: it ends before the others
};

}  // namespace relievo
