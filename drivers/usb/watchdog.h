// SPDX-License-Identifier: Apache-2.0
// Stops the motors of a USB device when forces no longer come: the last command would act on for ever.
#pragma once

#include <atomic>

#include "drivers/usb/usb_port.h"
#include "platform/clock.h"
#include "platform/cyclic_thread.h"

namespace relievo {

// `start` and `stop` on the owner's thread; `feed` and `check` on the real-time one. With a thread of its own it acts
// also when that one hangs: at a higher priority, on the system's clock.
class Watchdog final : private CyclicTask {
 public:
  static constexpr Duration kPatience = std::chrono::milliseconds(20);
  static constexpr int kWatchPriority = 85;  // of SCHED_FIFO, above the haptic task's

  explicit Watchdog(UsbPort& port) : port_(port), thread_(clock_) {}

  // Exhausted when no thread can be made.
  [[nodiscard]] Result<void> start(bool own_thread);
  void stop() noexcept { thread_.stop(); }

  // A command is on its way.
  void feed(MonotonicTime now) RELIEVO_RT { fed_ns_.store(now.time_since_epoch().count(), std::memory_order_relaxed); }
  // True once after each time that the device was quietened; without a thread it is done here.
  bool check(MonotonicTime now) RELIEVO_RT;

 private:
  static constexpr Duration::rep kQuiet = -1;  // in place of a time: nothing to watch
  LoopControl loop(const Cycle& cycle) RELIEVO_RT override;
  void bark(MonotonicTime now) RELIEVO_RT;

  UsbPort& port_;
  MonotonicClock clock_;
  bool own_thread_ = false;
  std::atomic<Duration::rep> fed_ns_{kQuiet};
  std::atomic<bool> barked_{false};
  CyclicThread thread_;
};

}  // namespace relievo
