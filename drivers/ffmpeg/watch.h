// SPDX-License-Identifier: Apache-2.0
// Tells the library when to give up a call that waits.
#pragma once

#include <atomic>
#include <cerrno>

#include "drivers/ffmpeg/library.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

class Watch {
 public:
  // A new verb begins and may wait for so long.
  void begin(Duration patience) noexcept {
    expired_ = false;
    deadline_ = clock_.now() + patience;
  }
  void forgive() noexcept { cancelled_ = false; }
  void cancel() noexcept { cancelled_ = true; }

  [[nodiscard]] MonotonicTime now() const noexcept { return clock_.now(); }
  [[nodiscard]] bool cancelled() const noexcept { return cancelled_; }
  [[nodiscard]] bool givesUp() noexcept {
    if (clock_.now() >= deadline_.load()) expired_ = true;
    return cancelled_ || expired_;
  }
  static int callback(void* watch) noexcept { return static_cast<Watch*>(watch)->givesUp() ? 1 : 0; }

  // The error of a call that failed: the watch's own reason first.
  [[nodiscard]] Error explain(Error otherwise) const noexcept {
    if (cancelled_) return {ErrorCode::Cancelled, 0, "interrupted while waiting for the source"};
    if (expired_) return openError(AVERROR(ETIMEDOUT));
    return otherwise;
  }

 private:
  MonotonicClock clock_;
  std::atomic<MonotonicTime> deadline_;  // atomic, since threads of the library ask as well
  std::atomic<bool> expired_{false};
  std::atomic<bool> cancelled_{false};
};

}  // namespace relievo::ffmpeg
