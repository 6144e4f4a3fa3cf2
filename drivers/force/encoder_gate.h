// SPDX-License-Identifier: Apache-2.0
// Rejects encoder readings that no hand can have caused, since the packets have no checksum.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "platform/realtime.h"

namespace relievo {

// Counts of the encoders on a device's three motors.
using EncoderCounts = std::array<std::int16_t, 3>;

// A reading is accepted if it is within the slack, for each tick that has passed, of the extrapolation of the last two.
// The slack is the counts that the highest acceleration of a hand makes in a tick, plus rounding; a smaller error looks
// like motion. A reading further off is accepted once the next one confirms it, so that hitting an end stop costs one
// tick.
class EncoderGate {
 public:
  static constexpr int kRounding = 2;

  // `mm_per_count`: of the joint with the finest counts. `rate_hz`: ticks a second.
  EncoderGate(double mm_per_count, double rate_hz)
      : slack_(slackFor(mm_per_count, rate_hz)),
        longest_wait_(std::max(1, static_cast<int>(std::lround(kLongestWaitS * rate_hz)))) {}

  // Counts per tick.
  [[nodiscard]] static int slackFor(double mm_per_count, double rate_hz) {
    return kRounding + static_cast<int>(std::ceil(kHighestAccelerationMmPerS2 / (rate_hz * rate_hz) / mm_per_count));
  }

  void reset(const EncoderCounts& counts) RELIEVO_RT {
    last_ = before_ = counts;
    apart_ = 1;
    waited_ = 0;
    doubted_ = false;
  }

  // Call on a tick without a reading.
  void skip() RELIEVO_RT { waited_ = std::min(waited_ + 1, longest_wait_); }

  // True: accepted as the current position. False: kept until the next one confirms it.
  bool accept(const EncoderCounts& counts) RELIEVO_RT {
    const int ticks = waited_ + 1;
    bool fits = true;
    bool confirmed = doubted_;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const int per_tick = (last_[i] - before_[i]) / apart_;
      fits = fits && std::abs(counts[i] - (last_[i] + per_tick * ticks)) <= slack_ * ticks;
      confirmed = confirmed && std::abs(counts[i] - suspect_[i]) <= slack_ + std::abs(per_tick);
    }
    if (!fits && !confirmed) {
      suspect_ = counts;
      doubted_ = true;
      skip();
      return false;
    }
    before_ = fits ? last_ : counts;
    apart_ = fits ? ticks : 1;
    last_ = counts;
    waited_ = 0;
    doubted_ = false;
    return true;
  }

 private:
  static constexpr double kHighestAccelerationMmPerS2 = 150e3;
  static constexpr double kLongestWaitS = 0.01;
  int slack_;
  int longest_wait_;  // ticks
  EncoderCounts last_{}, before_{}, suspect_{};
  int apart_ = 1;   // ticks between `before_` and `last_`
  int waited_ = 0;  // ticks since `last_`
  bool doubted_ = false;
};

}  // namespace relievo
