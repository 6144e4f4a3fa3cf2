// SPDX-License-Identifier: Apache-2.0
// A line that tells how far the work is.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

#include "platform/clock.h"
#include "platform/log.h"

namespace relievo {

// How far the work is: on a terminal one line on stderr that is written over and is gone at the end; elsewhere a line
// of the log every ten seconds, so that a short job says nothing and a long one is seen to live.
class ProgressLine {
 public:
  static constexpr Duration kTerminalPause = std::chrono::milliseconds(200);
  static constexpr Duration kLogPause = std::chrono::seconds(10);

  ProgressLine() : ProgressLine(systemClock(), ::isatty(STDERR_FILENO) == 1) {}
  // `clock` outlives it.
  ProgressLine(const Clock& clock, bool on_terminal)
      : clock_(clock), on_terminal_(on_terminal), start_(clock.now()), last_(start_) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() {
    if (on_terminal_ && shown_) std::fputs("\r\033[K", stderr);
  }

  // `text(elapsed)` answers the line; what comes too soon after the last one is left out.
  template <class Text>
  void show(Text&& text) {
    const Duration pause = !on_terminal_ ? kLogPause : shown_ ? kTerminalPause : Duration(0);
    if (clock_.now() - last_ >= pause) put(text(elapsed()));
  }
  // At once, on a terminal: for steps that take long.
  void say(const std::string& text) {
    if (on_terminal_) put(text);
    else show([&](Duration) { return text; });
  }
  [[nodiscard]] Duration elapsed() const noexcept { return clock_.now() - start_; }

 private:
  static const Clock& systemClock() {
    static const MonotonicClock clock{};  // has no state
    return clock;
  }
  void put(const std::string& text) {
    shown_ = true;
    last_ = clock_.now();
    if (!on_terminal_) return log(LogLevel::Info, "at work", "%s", text.c_str());
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    std::fflush(stderr);
  }

  const Clock& clock_;
  bool on_terminal_;
  MonotonicTime start_, last_;
  bool shown_ = false;
};

}  // namespace relievo
