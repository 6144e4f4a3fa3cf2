// SPDX-License-Identifier: Apache-2.0
// Rejects encoder readings that no hand can have caused, since the packets have no checksum.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>

#include "platform/realtime.h"

namespace relievo {

// Of a device's three motors.
using EncoderCounts = std::array<std::int16_t, 3>;

// A reading is accepted if it is within `slack_per_tick` counts, for each tick that has passed, of the extrapolation of
// the last two. The slack is the counts that kHighestAccelerationMmPerTick2 makes in a tick, plus rounding; a smaller
// error looks like motion. A reading further off is accepted once the next one confirms it, so that hitting an end stop
// costs one tick.
class EncoderGate {
 public:
  static constexpr double kHighestAccelerationMmPerTick2 = 0.15;  // 150 m/s^2 at 1 kHz
  static constexpr int kRounding = 2;

  explicit EncoderGate(int slack_per_tick) RELIEVO_RT : slack_(slack_per_tick) {}

  void reset(const EncoderCounts& counts) RELIEVO_RT {
    last_ = before_ = counts;
    apart_ = 1;
    waited_ = 0;
    doubted_ = false;
  }

  // Call on a tick without a reading.
  void skip() RELIEVO_RT { waited_ = waited_ < kLongestWait ? waited_ + 1 : waited_; }

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
  static constexpr int kLongestWait = 10;
  int slack_;
  EncoderCounts last_{}, before_{}, suspect_{};
  int apart_ = 1;   // ticks between `before_` and `last_`
  int waited_ = 0;  // ticks since `last_`
  bool doubted_ = false;
};

}  // namespace relievo
