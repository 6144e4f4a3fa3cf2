// SPDX-License-Identifier: Apache-2.0
// Monotonic time and its clocks: the system's, and one that a test sets.
#pragma once

#include <atomic>
#include <chrono>

#include "platform/realtime.h"

namespace relievo {

using Duration = std::chrono::nanoseconds;

// A tag, not a clock: the compiler rejects mixing monotonic times with those of another time line, such as media time.
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

// Thread-safe. `now` is real-time safe; `sleepUntil` is the only wait that a real-time loop may make.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual MonotonicTime now() const noexcept = 0;
  // Returns at or after `deadline`; at once if it has passed.
  virtual void sleepUntil(MonotonicTime deadline) noexcept = 0;
};

// CLOCK_MONOTONIC; sleeps with an absolute clock_nanosleep, so that lateness does not accumulate.
class MonotonicClock final : public Clock {
 public:
  [[nodiscard]] MonotonicTime now() const noexcept override;
  void sleepUntil(MonotonicTime deadline) noexcept override;
};

// Changes only when advanced. `sleepUntil` advances it to the deadline: a loop on this clock runs in simulated time.
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
