// SPDX-License-Identifier: Apache-2.0
// Measures how old the pictures of a live film are when they are seen and felt. Pure.
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
  // A picture that was `picture` old came onto the screen; the surface under the finger was `touch` old.
  void add(Duration picture, Duration touch) noexcept {
    picture_.add(picture);
    touch_.add(touch);
  }
  // Nothing of a film that is not live.
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
