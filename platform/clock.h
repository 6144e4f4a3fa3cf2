// SPDX-License-Identifier: Apache-2.0
// Monotonic time, and the clocks that tell it: the system's and one that a test turns by hand.
#pragma once

#include <atomic>
#include <chrono>

#include "platform/realtime.h"

namespace relievo {

using Duration = std::chrono::nanoseconds;

// A tag, not a clock: a time on this line cannot be mixed with one on another line, such as media time.
struct MonotonicTimeline {
  using duration = Duration;
};
using MonotonicTime = std::chrono::time_point<MonotonicTimeline, Duration>;

[[nodiscard]] constexpr double toSeconds(Duration d) noexcept {
  return static_cast<double>(d.count()) * 1e-9;
}
[[nodiscard]] constexpr Duration fromSeconds(double s) noexcept {
  return Duration(static_cast<Duration::rep>(s * 1e9 + (s < 0 ? -0.5 : 0.5)));
}

// Thread-safe. `now` is real-time safe; `sleepUntil` is the one wait that a real-time loop may make.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual MonotonicTime now() const noexcept = 0;
  // Returns at or after `deadline`; at once when it has passed.
  virtual void sleepUntil(MonotonicTime deadline) noexcept = 0;
};

// CLOCK_MONOTONIC; sleeps with an absolute clock_nanosleep, so that lateness does not add up.
class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] MonotonicTime now() const noexcept override;
  void sleepUntil(MonotonicTime deadline) noexcept override;
};

// Stands still until told. `sleepUntil` moves it to the deadline: a loop on this clock runs in simulated time.
class ManualClock final : public Clock {
 public:
  explicit ManualClock(MonotonicTime start = MonotonicTime{}) noexcept : now_(start.time_since_epoch().count()) {}
  [[nodiscard]] MonotonicTime now() const noexcept override;
  void sleepUntil(MonotonicTime deadline) noexcept override;
  void advance(Duration by) noexcept;

 private:
  std::atomic<Duration::rep> now_;
};

}  // namespace relievo
