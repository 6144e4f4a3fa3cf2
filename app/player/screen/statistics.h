// SPDX-License-Identifier: Apache-2.0
// The figures of the run as rows on the screen.
#pragma once

#include <cstdint>

#include "app/player/report.h"
#include "app/player/screen/screen_text.h"
#include "platform/clock.h"

namespace relievo {

// Figures change once a second.
class Statistics {
 public:
  // True if the rows should be updated.
  [[nodiscard]] bool isDue(MonotonicTime now) const noexcept { return now >= next_; }
  [[nodiscard]] ScreenRows rows(const PlayReport& report, const FingerForces& forces_n, MonotonicTime now);

 private:
  MonotonicTime next_, last_;
  std::uint64_t shown_ = 0;
};

}  // namespace relievo
