// SPDX-License-Identifier: Apache-2.0
// Keeps encoder words out that no hand can have caused: the packets carry no checksum.
#pragma once

#include <cstdint>
#include <cstdlib>

#include "drivers/falcon/packet.h"

namespace relievo::falcon {

// A word may differ from where the last two would lead by what an acceleration of 150 m/s^2 does in a tick (4 counts)
// and by rounding (2), for each tick that has passed; what differs by less, 0.23 mm, cannot be told from motion by
// anybody. A word further off is believed when the next one agrees with it, so that a blow against an end stop costs
// one tick.
class EncoderGate {
 public:
  void reset(const Counts& counts) RELIEVO_RT {
    last_ = before_ = counts;
    apart_ = 1;
    waited_ = 0;
    doubted_ = false;
  }

  // A tick without a word.
  void skip() RELIEVO_RT { waited_ = waited_ < kLongestWait ? waited_ + 1 : waited_; }

  // True: it is the position now. False: it is kept aside.
  bool accept(const Counts& counts) RELIEVO_RT {
    const int ticks = waited_ + 1;
    bool fits = true;
    bool confirmed = doubted_;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const int per_tick = (last_[i] - before_[i]) / apart_;
      fits = fits && std::abs(counts[i] - (last_[i] + per_tick * ticks)) <= kSlackPerTick * ticks;
      confirmed = confirmed && std::abs(counts[i] - suspect_[i]) <= kSlackPerTick + std::abs(per_tick);
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
  static constexpr int kSlackPerTick = 6;
  static constexpr int kLongestWait = 10;
  Counts last_{}, before_{}, suspect_{};
  int apart_ = 1;   // ticks between `before_` and `last_`
  int waited_ = 0;  // ticks since `last_`
  bool doubted_ = false;
};

}  // namespace relievo::falcon
