// SPDX-License-Identifier: Apache-2.0
// Log lines on stderr; and a ring through which the real-time thread passes lines for another thread to print.
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

// The areas that can have a log level of their own. Any other area (a file's name) uses the general level.
inline constexpr std::array<std::string_view, 7> kLogAreas{"control", "cyclic", "haptic", "media",
                                                           "play",    "remote", "render"};

// Sets the level of every area; lines above it are not printed. Initially Info. Thread-safe.
void setLogLevel(LogLevel level) noexcept;
// Sets the level of one area; ignored if it is not in kLogAreas. Thread-safe.
void setLogLevel(std::string_view area, LogLevel level) noexcept;
// Thread-safe; not for a real-time loop, since it searches a list.
[[nodiscard]] LogLevel logLevel(std::string_view area) noexcept;

// Sets the first word of each line, a string literal; initially "relievo". Where stderr goes to the systemd journal,
// a line begins with its priority ("<4>"). Thread-safe.
void setLogProgram(const char* name) noexcept;

// Prints one line "PROGRAM: area: text". Thread-safe, not real-time safe.
[[gnu::format(printf, 3, 4)]] void log(LogLevel level, const char* area, const char* format, ...) noexcept;

// A line at the foot of a terminal, without a line break: the next call overwrites it, and so does a line of the log,
// which then stands above the next one. `text` empty: removes it. One thread.
void showStatusLine(std::string_view text) noexcept;

// One record from the real-time thread, which does no formatting: a string literal and up to two numbers. It is printed
// as "text a b"; a number that is NaN is left out.
struct LogRecord {
  LogLevel level = LogLevel::Info;
  const char* text = "";
  double a = std::numeric_limits<double>::quiet_NaN();
  double b = std::numeric_limits<double>::quiet_NaN();
};

// One real-time producer, one consumer. A record that does not fit is counted, and `drain` prints the count. `area` is
// a string literal; its level is read once, when the ring is made.
class RingLog {
 public:
  explicit RingLog(const char* area) noexcept : area_(area), level_(logLevel(area)) {}
  void push(const LogRecord& record) RELIEVO_RT {
    if (record.level > level_) return;
    if (!ring_.tryPush(record)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
  // Prints the records since the last call. Not real-time safe.
  void drain() noexcept;

 private:
  const char* const area_;
  const LogLevel level_;
  SpscRing<LogRecord, 256> ring_;
  std::atomic<std::uint32_t> lost_{0};
};

}  // namespace relievo
