// SPDX-License-Identifier: Apache-2.0
// Calls of a library that may not return, one at a time, each on a helper thread.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <utility>

#include "platform/clock.h"
#include "platform/files/file_system_answer.h"

namespace relievo::alsa {

// Use on one thread. A call that still runs when this ends is left behind.
class OneCall {
 public:
  // `act` must own all that it uses, and is let go of before it counts as ended. None may run. Waits at most `brief`
  // for its end: the same as `ended` afterwards.
  bool start(std::function<void()> act, Duration brief) {
    last_ = std::make_shared<Call>();
    threads_.leave([call = last_, act = std::move(act)]() mutable {
      call->begun = true;
      act();
      act = nullptr;
      const std::scoped_lock lock(call->mutex);
      call->ended = true;
      call->end.notify_one();
    });
    return wait(brief);
  }
  // Waits for the end of the last one: the same as `ended` afterwards.
  bool wait(Duration patience) {
    if (last_ == nullptr) return true;
    std::unique_lock lock(last_->mutex);
    return last_->end.wait_for(lock, patience, [this] { return last_->ended; });
  }
  // False while no thread could be started for it.
  [[nodiscard]] bool begun() const noexcept { return last_ == nullptr || last_->begun; }
  // Begins it where that could not be done before.
  void tryAgain() {
    if (!begun()) threads_.leave([] {});
  }
  // On a helper thread: it may be closed there.
  void letGo(std::shared_ptr<void> what) {
    threads_.leave([what = std::move(what)] {});
  }
  // What it wrote is then this thread's. True before the first one.
  [[nodiscard]] bool ended() const {
    if (last_ == nullptr) return true;
    const std::scoped_lock lock(last_->mutex);
    return last_->ended;
  }

 private:
  struct Call {
    std::mutex mutex;
    std::condition_variable end;
    std::atomic<bool> begun = false;
    bool ended = false;
  };
  std::shared_ptr<Call> last_;
  FileSystemAnswers threads_;
};

}  // namespace relievo::alsa
