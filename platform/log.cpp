// SPDX-License-Identifier: Apache-2.0
// Lines on stderr. Each is composed on the stack and written in one call, so that lines of threads do not mix.
#include "platform/log.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "platform/text/plain_text.h"

namespace relievo {
namespace {

constexpr std::size_t kLineBytes = 1024;  // below PIPE_BUF: a pipe takes it whole or not at all

std::atomic<LogLevel> of_all{LogLevel::Info};
constexpr auto kAsAll = static_cast<LogLevel>(0xff);
struct AreaLevel {
  std::atomic<LogLevel> level{kAsAll};
};
std::array<AreaLevel, kLogAreas.size()> of_area;
std::atomic<const char*> program{"relievo"};
std::atomic<bool> status_shown{false};
constexpr const char* kEraseLine = "\r\033[K";

std::atomic<LogLevel>* levelOf(std::string_view area) noexcept {
  const auto* const found = std::ranges::find(kLogAreas, area);
  return found == kLogAreas.end() ? nullptr : &of_area[static_cast<std::size_t>(found - kLogAreas.begin())].level;
}

// systemd sets $JOURNAL_STREAM to "DEVICE:INODE" of the stream that it connects to the journal (systemd.exec(5)).
bool stderrIsTheJournal() noexcept {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat file{};
  if (stream == nullptr || ::fstat(STDERR_FILENO, &file) != 0) return false;
  char ours[64];
  std::snprintf(ours, sizeof ours, "%ju:%ju", static_cast<std::uintmax_t>(file.st_dev),
                static_cast<std::uintmax_t>(file.st_ino));
  return std::strcmp(stream, ours) == 0;
}

// sd-daemon(3)
const char* priority(LogLevel level) noexcept {
  static const bool wanted = stderrIsTheJournal();
  constexpr std::array kPriorities{"<3>", "<4>", "<6>", "<7>"};
  return wanted ? kPriorities[static_cast<std::size_t>(level)] : "";
}

// How many bytes of a buffer of `room` bytes snprintf has filled; it cuts off the rest.
std::size_t filled(int wanted, std::size_t room) noexcept {
  return wanted < 0 ? 0 : std::min(static_cast<std::size_t>(wanted), room - 1);
}

// Replaces control characters by spaces: file names and messages of libraries may hold line breaks.
std::size_t makeOneLine(char* text, std::size_t length) noexcept {
  blankControls({text, length}, Lines::Join);
  while (length > 0 && text[length - 1] == ' ') --length;
  return length;
}

void writeAll(const char* bytes, std::size_t count) noexcept {
  while (count > 0) {
    const ssize_t done = ::write(STDERR_FILENO, bytes, count);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return;  // stderr is closed or full: the failure cannot be reported anywhere
    bytes += done;
    count -= static_cast<std::size_t>(done);
  }
}

}  // namespace

std::optional<LogLevel> logLevelOf(std::string_view word) noexcept {
  constexpr std::array<std::string_view, 4> kWords{"error", "warning", "info", "debug"};
  const auto* const found = std::ranges::find(kWords, word);
  if (found == kWords.end()) return std::nullopt;
  return static_cast<LogLevel>(found - kWords.begin());
}

void setLogLevel(LogLevel level) noexcept {
  of_all.store(level, std::memory_order_relaxed);
  for (AreaLevel& each : of_area) each.level.store(kAsAll, std::memory_order_relaxed);
}

void setLogLevel(std::string_view area, LogLevel level) noexcept {
  if (auto* const its_own = levelOf(area)) its_own->store(level, std::memory_order_relaxed);
}

LogLevel logLevel(std::string_view area) noexcept {
  const auto* const its_own = levelOf(area);
  const LogLevel level = its_own == nullptr ? kAsAll : its_own->load(std::memory_order_relaxed);
  return level == kAsAll ? of_all.load(std::memory_order_relaxed) : level;
}

void setLogProgram(const char* name) noexcept {
  program.store(name, std::memory_order_relaxed);
}

void log(LogLevel level, const char* area, const char* format, ...) noexcept {
  if (level > logLevel(area)) return;
  const int kept_errno = errno;  // callers often log between a failure and reading errno
  char line[kLineBytes];
  constexpr std::size_t kRoom = sizeof line - 1;  // the last byte is the newline's
  const char* const name = program.load(std::memory_order_relaxed);
  const char* const erase = status_shown.exchange(false) ? kEraseLine : "";
  const std::size_t before = std::strlen(erase);
  std::size_t length = filled(std::snprintf(line, kRoom, "%s%s%s: %s: ", erase, priority(level), name, area), kRoom);
  va_list arguments;
  va_start(arguments, format);
  length += filled(std::vsnprintf(line + length, kRoom - length, format, arguments), kRoom - length);
  va_end(arguments);
  length = before + makeOneLine(line + before, length - before);
  line[length++] = '\n';
  writeAll(line, length);
  errno = kept_errno;
}

void showStatusLine(std::string_view text) noexcept {
  if (!status_shown.exchange(!text.empty()) && text.empty()) return;
  char line[kLineBytes];
  const int wanted = std::snprintf(line, sizeof line, "%s%.*s", kEraseLine, static_cast<int>(text.size()), text.data());
  writeAll(line, filled(wanted, sizeof line));
}

void RingLog::drain() noexcept {
  while (const std::optional<LogRecord> record = ring_.tryPop()) {
    const auto& [level, text, a, b] = *record;
    if (!std::isnan(b)) {
      log(level, area_, "%s %g %g", text, a, b);
    } else if (!std::isnan(a)) {
      log(level, area_, "%s %g", text, a);
    } else {
      log(level, area_, "%s", text);
    }
  }
  const std::uint32_t lost = lost_.exchange(0, std::memory_order_relaxed);
  if (lost > 0) log(LogLevel::Warning, area_, "%u log lines dropped: they came faster than they were printed", lost);
}

}  // namespace relievo
