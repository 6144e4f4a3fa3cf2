// SPDX-License-Identifier: Apache-2.0
// Time-out and cancellation of FFmpeg's blocking calls, as its interrupt callback.
#pragma once

#include <atomic>
#include <optional>

#include "drivers/ffmpeg/library.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

inline constexpr Error kInterruptedWait{ErrorCode::Cancelled, 0, "interrupted while waiting for the source"};

class Watch {
 public:
  // Starts a call that may wait for `patience`, after which it fails with `late`.
  void begin(Duration patience, const Error& late = kLateAnswer) noexcept {
    late_ = late;
    expired_ = false;
    unanswered_.reset();
    deadline_ = clock_.now() + patience;
  }
  void cancel() noexcept { cancelled_ = true; }

  [[nodiscard]] MonotonicTime now() const noexcept { return clock_.now(); }
  [[nodiscard]] bool cancelled() const noexcept { return cancelled_; }
  [[nodiscard]] const std::atomic<bool>& cancelFlag() const noexcept { return cancelled_; }
  [[nodiscard]] bool givesUp() noexcept {
    if (clock_.now() >= deadline_.load()) expired_ = true;
    return cancelled_ || expired_;
  }
  static int callback(void* watch) noexcept { return static_cast<Watch*>(watch)->givesUp() ? 1 : 0; }

  // The file system has not answered. Only on the thread that began the call.
  void noteUnanswered(const Error& error) noexcept { unanswered_ = error; }

  // The error of a failed call: cancelled, unanswered or timed out if so, else `otherwise`.
  [[nodiscard]] Error explain(Error otherwise) const noexcept {
    if (cancelled_) return kInterruptedWait;
    if (unanswered_) return *unanswered_;
    if (expired_) return late_;
    return otherwise;
  }

 private:
  MonotonicClock clock_;
  std::atomic<MonotonicTime> deadline_;  // atomic, since FFmpeg's threads read it as well
  std::atomic<bool> expired_{false};
  std::atomic<bool> cancelled_{false};
  std::optional<Error> unanswered_;
  Error late_ = kLateAnswer;
};

}  // namespace relievo::ffmpeg
