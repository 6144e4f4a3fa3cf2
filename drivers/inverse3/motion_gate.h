// SPDX-License-Identifier: Apache-2.0
// Rejects positions that no hand can have caused: the messages have neither a number nor a time.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "platform/clock.h"
#include "platform/realtime.h"

namespace relievo::inverse3 {

// A position is accepted if it is as near to the extrapolation of the last two as the highest acceleration of a hand
// allows. One further off is accepted once kConfirmations more in a row agree with it: after a gap the hand is
// elsewhere.
class MotionGate {
 public:
  static constexpr double kSlackMmPerMs = 0.15;  // 150 m/s^2 at 1 kHz
  static constexpr double kNoiseMm = 0.05;
  static constexpr int kConfirmations = 4;

  // After this, the next position must be confirmed.
  void forget() RELIEVO_RT {
    known_ = false;
    doubts_ = 0;
  }

  // `asked`: when the position was asked for; it was measured then or within `age`.
  bool accept(const glm::dvec3& position_mm, MonotonicTime asked, Duration age) RELIEVO_RT {
    if (known_ && fits(last_, position_mm, asked, age)) {
      last_ = follow(last_, position_mm, asked);
      doubts_ = 0;
      return true;
    }
    const bool agrees = doubts_ > 0 && fits(doubted_, position_mm, asked, age);
    doubted_ = agrees ? follow(doubted_, position_mm, asked) : Place{position_mm, asked, glm::dvec3(0)};
    doubts_ = agrees ? doubts_ + 1 : 1;
    if (doubts_ <= kConfirmations) return false;
    last_ = doubted_;
    known_ = true;
    doubts_ = 0;
    return true;
  }

 private:
  static constexpr double kLongestMs = 20;    // of an extrapolation
  static constexpr double kShortestMs = 0.2;  // shortest interval from which a velocity can be computed
  static constexpr double kFastestMmPerMs = 5;

  struct Place {
    glm::dvec3 position_mm{0};
    MonotonicTime time;
    glm::dvec3 mm_per_ms{0};
  };
  static double msSince(MonotonicTime then, MonotonicTime now) RELIEVO_RT {
    return std::clamp(1e3 * toSeconds(now - then), 0.0, kLongestMs);
  }
  static bool fits(const Place& place, const glm::dvec3& position_mm, MonotonicTime asked, Duration age) RELIEVO_RT {
    const double ms = msSince(place.time, asked);
    const double slack = kNoiseMm + kSlackMmPerMs * ms + glm::length(place.mm_per_ms) * 1e3 * toSeconds(age);
    return glm::distance(position_mm, place.position_mm + ms * place.mm_per_ms) <= slack;
  }
  static Place follow(const Place& place, const glm::dvec3& position_mm, MonotonicTime asked) RELIEVO_RT {
    const double ms = msSince(place.time, asked);
    if (ms < kShortestMs) return {position_mm, asked, place.mm_per_ms};
    const glm::dvec3 velocity = (position_mm - place.position_mm) / ms;
    return {position_mm, asked, velocity * std::min(1.0, kFastestMmPerMs / std::max(glm::length(velocity), 1e-9))};
  }

  Place last_, doubted_;
  bool known_ = false;
  int doubts_ = 0;  // positions in a row that agree with each other, not with the last accepted one
};

}  // namespace relievo::inverse3
