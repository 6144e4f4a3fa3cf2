// SPDX-License-Identifier: Apache-2.0
// Stops the motors of a haptic device when no more forces come, since the last command would otherwise act forever.
#pragma once

#include <atomic>

#include "drivers/force/force_port.h"
#include "platform/clock.h"
#include "platform/cyclic_thread.h"

namespace relievo {

// `start` and `stop` on the owner's thread; `feed` and `check` on the real-time one. With a thread of its own, at a
// higher priority and on the system's clock, it acts even if the real-time thread hangs.
class Watchdog final : private CyclicTask {
 public:
  static constexpr Duration kPatience = std::chrono::milliseconds(20);  // unless asked for another
  static constexpr int kWatchPriority = 85;                             // of SCHED_FIFO, above the haptic task's

  explicit Watchdog(ForcePort& port, Duration patience = kPatience)
      : port_(port), patience_(patience), thread_(clock_) {}
  [[nodiscard]] Duration patience() const RELIEVO_RT { return patience_; }

  // Exhausted if no thread can be created.
  [[nodiscard]] Result<void> start(bool own_thread);
  void stop() noexcept { thread_.stop(); }

  // Call for each command sent.
  void feed(MonotonicTime now) RELIEVO_RT { fed_ns_.store(now.time_since_epoch().count(), std::memory_order_relaxed); }
  // True once after each time that the watchdog stopped the motors. Without a thread of its own, it checks here.
  bool check(MonotonicTime now) RELIEVO_RT;

 private:
  static constexpr Duration::rep kQuiet = -1;  // instead of a time: the motors are stopped, nothing to watch
  LoopControl loop(const Cycle& cycle) RELIEVO_RT override;
  void bark(MonotonicTime now) RELIEVO_RT;

  ForcePort& port_;
  const Duration patience_;
  MonotonicClock clock_;
  bool own_thread_ = false;
  std::atomic<Duration::rep> fed_ns_{kQuiet};
  std::atomic<bool> barked_{false};
  CyclicThread thread_;
};

}  // namespace relievo
