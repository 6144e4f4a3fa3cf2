// SPDX-License-Identifier: Apache-2.0
// Lines for people on stderr; and a ring through which the real-time thread hands in what it may not print itself.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "platform/realtime.h"
#include "platform/spsc_ring.h"

namespace relievo {

enum class LogLevel : std::uint8_t { Error, Warning, Info, Debug };

[[nodiscard]] std::optional<LogLevel> logLevelOf(std::string_view word) noexcept;  // "error", "warning", ..

// What lines are about, so far as they have levels of their own; a line about anything else (a file) has the level of
// all.
inline constexpr std::array<std::string_view, 7> kLogAreas{"control", "cyclic", "haptic", "media",
                                                           "play",    "remote", "render"};

// Lines above this level are not printed; Info at start. Of every area. Thread-safe.
void setLogLevel(LogLevel level) noexcept;
// Of one area; one that is not in the list changes nothing. Thread-safe.
void setLogLevel(std::string_view area, LogLevel level) noexcept;
// Reads an atomic; the search makes it too long for a real-time loop. Thread-safe.
[[nodiscard]] LogLevel logLevel(std::string_view area) noexcept;

// What each line begins with: a string literal; "relievo" at start. Where stderr is the journal's, a line begins with
// its priority as well ("<4>"). Thread-safe.
void setLogProgram(const char* name) noexcept;

// Prints one line "PROGRAM: area: text". Thread-safe, not real-time safe.
[[gnu::format(printf, 3, 4)]] void log(LogLevel level, const char* area, const char* format, ...) noexcept;

// One record from the real-time side: a string literal and up to two numbers, no formatting there. It is printed as
// "text a b"; a number that is not given (NaN) is not printed.
struct LogRecord {
  LogLevel level = LogLevel::Info;
  const char* text = "";
  double a = std::numeric_limits<double>::quiet_NaN();
  double b = std::numeric_limits<double>::quiet_NaN();
};

// One real-time producer, one consumer. A record that does not fit is counted, and the count is printed by `drain`.
// `area` is a string literal; its level is the one that it has when the ring is made.
class RingLog {
 public:
  explicit RingLog(const char* area) noexcept : area_(area), level_(logLevel(area)) {}
  void push(const LogRecord& record) RELIEVO_RT {
    if (record.level > level_) return;
    if (!ring_.tryPush(record)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
  // Prints what has come since the last call. Not real-time safe.
  void drain() noexcept;

 private:
  const char* const area_;
  const LogLevel level_;
  SpscRing<LogRecord, 256> ring_;
  std::atomic<std::uint32_t> lost_{0};
};

}  // namespace relievo
