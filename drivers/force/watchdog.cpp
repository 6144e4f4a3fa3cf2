// SPDX-License-Identifier: Apache-2.0
// Checks four times within its patience.
#include "drivers/force/watchdog.h"

namespace relievo {

Result<void> Watchdog::start(bool own_thread) {
  fed_ns_ = kQuiet;
  barked_ = false;
  own_thread_ = own_thread;
  if (!own_thread) return {};
  const CyclicConfig config{.name = "relievo-watch", .period = patience_ / 4, .priority = kWatchPriority};
  const auto started = thread_.start(config, *this);
  if (!started) return std::unexpected(started.error());
  return {};
}

LoopControl Watchdog::loop(const Cycle& cycle) RELIEVO_RT {
  bark(cycle.woken);
  return LoopControl::Continue;
}

bool Watchdog::check(MonotonicTime now) RELIEVO_RT {
  if (!own_thread_) bark(now);
  return barked_.exchange(false, std::memory_order_relaxed);
}

void Watchdog::bark(MonotonicTime now) RELIEVO_RT {
  Duration::rep fed = fed_ns_.load(std::memory_order_relaxed);
  if (fed == kQuiet || now.time_since_epoch().count() - fed <= patience_.count()) return;
  // If it was fed meanwhile, there is nothing to do.
  if (!fed_ns_.compare_exchange_strong(fed, kQuiet, std::memory_order_relaxed)) return;
  barked_.store(true, std::memory_order_relaxed);
  if (port_.quieten()) return;
  Duration::rep quiet = kQuiet;  // the device did not accept it: try again at the next check
  fed_ns_.compare_exchange_strong(quiet, fed, std::memory_order_relaxed);
}

}  // namespace relievo
