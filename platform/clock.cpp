// SPDX-License-Identifier: Apache-2.0
// The two clocks: the kernel's monotonic one, and one that a test sets.
#include "platform/clock.h"

#include <cerrno>
#include <ctime>

namespace relievo {

namespace {
constexpr Duration::rep kNsPerSecond = 1'000'000'000;
}

MonotonicTime MonotonicClock::now() const noexcept {
  timespec ts{};
  ::clock_gettime(CLOCK_MONOTONIC, &ts);  // cannot fail: the clock exists and the address is good
  return MonotonicTime(Duration(static_cast<Duration::rep>(ts.tv_sec) * kNsPerSecond + ts.tv_nsec));
}

void MonotonicClock::sleepUntil(MonotonicTime deadline) noexcept {
  const Duration::rep ns = deadline.time_since_epoch().count();
  if (ns <= 0) return;  // already passed; the kernel would reject a negative time
  timespec ts{};
  ts.tv_sec = static_cast<decltype(ts.tv_sec)>(ns / kNsPerSecond);
  ts.tv_nsec = static_cast<decltype(ts.tv_nsec)>(ns % kNsPerSecond);
  // The deadline is absolute: after a signal, sleep again until the same time.
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &ts, nullptr) == EINTR) {
  }
}

MonotonicTime ManualClock::now() const noexcept {
  return MonotonicTime(Duration(now_.load(std::memory_order_acquire)));
}

void ManualClock::sleepUntil(MonotonicTime deadline) noexcept {
  const Duration::rep target = deadline.time_since_epoch().count();
  Duration::rep seen = now_.load(std::memory_order_acquire);
  while (seen < target && !now_.compare_exchange_weak(seen, target, std::memory_order_acq_rel)) {
  }
}

void ManualClock::advance(Duration by) noexcept {
  now_.fetch_add(by.count(), std::memory_order_acq_rel);
}

}  // namespace relievo
