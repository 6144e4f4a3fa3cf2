// SPDX-License-Identifier: Apache-2.0
// Words for people: formatted text, and a line on the terminal that tells how far the work is.
#pragma once

#include <unistd.h>

#include <cstdarg>
#include <cstdio>
#include <string>

#include "platform/clock.h"

namespace relievo {

// snprintf into a string, at most 1 kB.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] inline std::string print(const char* format, ...) {
  char text[1024];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

// One line on stderr that is written over, on a terminal only; gone at the end.
class ProgressLine {
 public:
  ProgressLine() = default;
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }

  // `text(elapsed)` answers the line; what comes sooner than a fifth of a second after the last one is left out.
  template <class Text>
  void show(Text&& text) {
    if (on_terminal_ && (!shown_ || clock_.now() - last_ >= std::chrono::milliseconds(200))) say(text(elapsed()));
  }
  // Always: for steps that take long.
  void say(const std::string& text) {
    if (!on_terminal_) return;
    shown_ = true;
    last_ = clock_.now();
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    std::fflush(stderr);
  }
  [[nodiscard]] Duration elapsed() const noexcept { return clock_.now() - start_; }

 private:
  MonotonicClock clock_;
  bool on_terminal_ = ::isatty(STDERR_FILENO) == 1;
  MonotonicTime start_ = clock_.now(), last_ = start_;
  bool shown_ = false;
};

}  // namespace relievo
