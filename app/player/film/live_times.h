// SPDX-License-Identifier: Apache-2.0
// Measures the delay of a live film from camera to screen and finger. Pure.
#pragma once

#include <optional>

#include "platform/clock.h"
#include "platform/histogram.h"

namespace relievo {

struct LiveLatency {
  struct Times {
    double p50_ms = 0, p99_ms = 0, max_ms = 0;
  } picture, touch;
};

class LiveTimes {
 public:
  // The age of a picture when it came onto the screen, and of the surface under the finger then.
  void add(Duration picture, Duration touch) noexcept {
    picture_.add(picture);
    touch_.add(touch);
  }
  // Nullopt if no picture was counted: the film is not live.
  [[nodiscard]] std::optional<LiveLatency> summary() const {
    if (picture_.count() == 0) return std::nullopt;
    return LiveLatency{times(picture_), times(touch_)};
  }

 private:
  [[nodiscard]] static LiveLatency::Times times(const Histogram& histogram) {
    const auto ms = [](Duration d) { return 1e3 * toSeconds(d); };
    return {ms(histogram.quantile(0.5)), ms(histogram.quantile(0.99)), ms(histogram.max())};
  }

  Histogram picture_, touch_;
};

}  // namespace relievo
