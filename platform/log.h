// SPDX-License-Identifier: Apache-2.0
// Lines for people on stderr; and a ring through which the real-time thread hands in what it may not print itself.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

#include "platform/realtime.h"
#include "platform/spsc_ring.h"

namespace relievo {

enum class LogLevel : std::uint8_t { Error, Warning, Info, Debug };

// Lines above this level are not printed; Info at start. Thread-safe.
void setLogLevel(LogLevel level) noexcept;

// What each line begins with: a string literal; "relievo" at start. Thread-safe.
void setLogProgram(const char* name) noexcept;

// Prints one line "PROGRAM: area: text". Thread-safe, not real-time safe.
[[gnu::format(printf, 3, 4)]] void log(LogLevel level, const char* area, const char* format, ...) noexcept;

// One record from the real-time side: a string literal and up to two numbers, no formatting there. It is printed as
// "text a b"; a number that is not given (NaN) is not printed.
struct LogRecord {
  LogLevel level = LogLevel::Info;
  const char* area = "";
  const char* text = "";
  double a = std::numeric_limits<double>::quiet_NaN();
  double b = std::numeric_limits<double>::quiet_NaN();
};

// One real-time producer, one consumer. A record that does not fit is counted, and the count is printed by `drain`.
class RingLog {
 public:
  void push(const LogRecord& record) RELIEVO_RT {
    if (!ring_.tryPush(record)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
  // Prints what has come since the last call. Not real-time safe.
  void drain() noexcept;

 private:
  SpscRing<LogRecord, 256> ring_;
  std::atomic<std::uint32_t> lost_{0};
};

}  // namespace relievo
