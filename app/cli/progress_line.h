// SPDX-License-Identifier: Apache-2.0
// A line that shows progress.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <string>

#include "platform/clock.h"
#include "platform/log.h"

namespace relievo {

// On a terminal: one line on stderr that is overwritten and removed at the end. Elsewhere: a log line every ten
// seconds, so that a short job prints nothing and a long one shows that it is alive.
class ProgressLine {
 public:
  static constexpr Duration kTerminalPause = std::chrono::milliseconds(200);
  static constexpr Duration kLogPause = std::chrono::seconds(10);

  ProgressLine() : ProgressLine(systemClock(), ::isatty(STDERR_FILENO) == 1) {}
  // `clock` must outlive it.
  ProgressLine(const Clock& clock, bool on_terminal)
      : clock_(clock), on_terminal_(on_terminal), start_(clock.now()), last_(start_), counted_(start_) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() {
    if (on_terminal_ && shown_) std::fputs("\r\033[K", stderr);
  }

  // `text(elapsed)` returns the line; calls that come too soon after the last line are ignored.
  template <class Text>
  void show(Text&& text) {
    const Duration pause = !on_terminal_ ? kLogPause : shown_ ? kTerminalPause : Duration(0);
    if (clock_.now() - last_ >= pause) put(text(elapsed()));
  }
  // Of work in several passes: where `done` falls, a pass has begun, and with it the elapsed time.
  void count(std::uint64_t done) {
    if (done < done_) start_ = counted_;
    done_ = done;
    counted_ = clock_.now();
  }
  // On a terminal, prints at once: for steps that take long.
  void say(const std::string& text) {
    if (on_terminal_) put(text);
    else show([&](Duration) { return text; });
  }
  [[nodiscard]] Duration elapsed() const noexcept { return clock_.now() - start_; }

 private:
  static const Clock& systemClock() {
    static const MonotonicClock clock{};  // stateless
    return clock;
  }
  void put(const std::string& text) {
    shown_ = true;
    last_ = clock_.now();
    if (!on_terminal_) return log(LogLevel::Info, "progress", "%s", text.c_str());
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    std::fflush(stderr);
  }

  const Clock& clock_;
  bool on_terminal_;
  MonotonicTime start_, last_, counted_;
  bool shown_ = false;
  std::uint64_t done_ = 0;
};

}  // namespace relievo
