// SPDX-License-Identifier: Apache-2.0
// Lines on stderr, each put together on the stack and written in one call: threads do not interleave.
#include "platform/log.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace relievo {
namespace {

constexpr std::size_t kLineBytes = 1024;  // below PIPE_BUF: a pipe takes it whole or not at all

std::atomic<LogLevel> maximum{LogLevel::Info};
std::atomic<const char*> program{"relievo"};

bool printed(LogLevel level) noexcept {
  return level <= maximum.load(std::memory_order_relaxed);
}

// How much of a buffer of `room` bytes snprintf has filled; what did not fit is cut off.
std::size_t filled(int wanted, std::size_t room) noexcept {
  return wanted < 0 ? 0 : std::min(static_cast<std::size_t>(wanted), room - 1);
}

// A line stays a line whatever a file name or a library's message holds: control characters become spaces.
std::size_t makeOneLine(char* text, std::size_t length) noexcept {
  std::replace_if(text, text + length, [](char c) { return (c >= 0 && c < ' ') || c == 0x7f; }, ' ');
  while (length > 0 && text[length - 1] == ' ') --length;
  return length;
}

void writeAll(const char* bytes, std::size_t count) noexcept {
  while (count > 0) {
    const ssize_t done = ::write(STDERR_FILENO, bytes, count);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return;  // stderr is closed or full: there is nowhere left to say so
    bytes += done;
    count -= static_cast<std::size_t>(done);
  }
}

}  // namespace

void setLogLevel(LogLevel level) noexcept {
  maximum.store(level, std::memory_order_relaxed);
}

void setLogProgram(const char* name) noexcept {
  program.store(name, std::memory_order_relaxed);
}

void log(LogLevel level, const char* area, const char* format, ...) noexcept {
  if (!printed(level)) return;
  const int kept_errno = errno;  // a line is often printed between a failure and its report
  char line[kLineBytes];
  constexpr std::size_t kRoom = sizeof line - 1;  // the last byte is the newline's
  const char* const name = program.load(std::memory_order_relaxed);
  std::size_t length = filled(std::snprintf(line, kRoom, "%s: %s: ", name, area), kRoom);
  va_list arguments;
  va_start(arguments, format);
  length += filled(std::vsnprintf(line + length, kRoom - length, format, arguments), kRoom - length);
  va_end(arguments);
  length = makeOneLine(line, length);
  line[length++] = '\n';
  writeAll(line, length);
  errno = kept_errno;
}

void RingLog::drain() noexcept {
  while (const std::optional<LogRecord> record = ring_.tryPop()) {
    const auto& [level, area, text, a, b] = *record;
    if (!std::isnan(b)) {
      log(level, area, "%s %g %g", text, a, b);
    } else if (!std::isnan(a)) {
      log(level, area, "%s %g", text, a);
    } else {
      log(level, area, "%s", text);
    }
  }
  const std::uint32_t lost = lost_.exchange(0, std::memory_order_relaxed);
  if (lost > 0) log(LogLevel::Warning, "log", "%u lines lost: they came faster than they were printed", lost);
}

}  // namespace relievo
