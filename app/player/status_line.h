// SPDX-License-Identifier: Apache-2.0
// The line at the foot of the terminal while a film plays.
#pragma once

#include <cstddef>
#include <string>

#include "app/player/report.h"
#include "app/player/screen/screen_text.h"
#include "platform/clock.h"

namespace relievo {

// "playing 0:12 / 1:30 (13 %)  Volume 95 %  2x  dropped 0  force 1.25 N  missed ticks 0", at most `columns` long.
// `notice`: what a key has changed, if that was a moment ago.
[[nodiscard]] std::string statusText(const ScreenFacts& facts, const PlayReport& report, const FingerForces& forces_n,
                                     const std::string& notice, std::size_t columns);

// Prints on standard error, if that is a terminal. Player's thread only.
class StatusLine {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds(500);

  StatusLine();
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  // False without a terminal, and too soon after the last line.
  [[nodiscard]] bool isDue(MonotonicTime now) const noexcept { return on_terminal_ && now >= due_; }
  void show(const ScreenFacts& facts, const PlayReport& report, const FingerForces& forces_n, const std::string& notice,
            MonotonicTime now);
  void clear() noexcept;

 private:
  bool on_terminal_;
  MonotonicTime due_;
};

}  // namespace relievo
