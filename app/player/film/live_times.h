// SPDX-License-Identifier: Apache-2.0
// Measures the delay of a live film from camera to screen and finger, and how far the two are apart. Pure.
#pragma once

#include <algorithm>
#include <optional>

#include "hal/media/media_time.h"
#include "platform/clock.h"
#include "platform/histogram.h"

namespace relievo {

struct LiveLatency {
  struct Times {
    double p50_ms = 0, p99_ms = 0, max_ms = 0;
  };
  Times picture;               // age of a picture when it appears on the screen
  std::optional<Times> touch;  // age of the surface in every tick; nullopt without touch
  // When a picture appears: how much newer the surface is than the picture, and how much older.
  Times before, behind;
};

class LiveTimes {
 public:
  // The film plays from now on; media time 0 was captured at `origin`. Ticks before that do not count.
  void begin(MonotonicTime origin, MonotonicTime now) noexcept {
    origin_ = origin;
    begun_ = now;
  }
  // A picture of this age has appeared on the screen, while the surface under the finger had the age `surface`.
  void shown(Duration picture, Duration surface) noexcept {
    picture_.add(picture);
    before_.add(std::max(picture - surface, Duration(0)));
    behind_.add(std::max(surface - picture, Duration(0)));
  }
  // A tick has felt the surface of this moment of the film.
  void felt(MonotonicTime tick, MediaTime surface) noexcept {
    if (tick >= begun_) touch_.add(tick - (origin_ + surface.time_since_epoch()));
  }
  // Nullopt if no picture was counted, as for a film that is not live.
  [[nodiscard]] std::optional<LiveLatency> summary() const {
    if (picture_.count() == 0) return std::nullopt;
    LiveLatency latency{times(picture_), std::nullopt, times(before_), times(behind_)};
    if (touch_.count() > 0) latency.touch = times(touch_);
    return latency;
  }

 private:
  [[nodiscard]] static LiveLatency::Times times(const Histogram& histogram) {
    const auto ms = [](Duration d) { return 1e3 * toSeconds(d); };
    return {ms(histogram.quantile(0.5)), ms(histogram.quantile(0.99)), ms(histogram.max())};
  }

  MonotonicTime origin_, begun_ = MonotonicTime::max();
  Histogram picture_, touch_, before_, behind_;
};

}  // namespace relievo
