// SPDX-License-Identifier: Apache-2.0
// Media time: the time line of a film, a type apart from the machine's time.
#pragma once

#include <chrono>

#include "platform/clock.h"

namespace relievo {

struct MediaTimeline {
  using duration = Duration;
};
// Nanoseconds from the film's own zero. A clock (hal/media/media_clock.h) maps it to MonotonicTime; nothing else does.
using MediaTime = std::chrono::time_point<MediaTimeline, Duration>;

[[nodiscard]] constexpr double toSeconds(MediaTime t) noexcept {
  return toSeconds(t.time_since_epoch());
}
[[nodiscard]] constexpr MediaTime mediaTime(double s) noexcept {
  return MediaTime(fromSeconds(s));
}

}  // namespace relievo
