// SPDX-License-Identifier: Apache-2.0
// Limits that several scenarios share, each with the reason for its value.
#pragma once

#include "app/lab/scenario/judge.h"

namespace relievo::scenario {

// Jones, Kinesthetic sensing (2000): people tell two forces apart from about 6 % on.
inline constexpr Limit kForceDifference{6, "%", "cited: people notice 6 % of a force (Jones 2000)"};
inline constexpr Limit kForceMatches{5, "%", "cited: less than the 6 % of a force that people notice (Jones 2000)"};
inline constexpr Limit kForceNotAbove{105, "%", kForceMatches.origin};
inline constexpr Limit kForceNotBelow{95, "%", kForceMatches.origin};
inline constexpr Limit kNothingAdded{102, "%", "derived: a third of the 6 % that people notice (Jones 2000)"};
// Barbagli, Salisbury, Ho, Spence and Tan, Haptic discrimination of force direction (2006).
inline constexpr Limit kDirectionMatches{
    10, "deg", "derived: a third of the 25 to 35 degrees that people notice (Barbagli et al. 2006)"};
inline constexpr Limit kHalfIsFelt{
    50, "%",
    "chosen: contact that came back has 96 % or more and contact that is gone has 0; any limit between separates them"};
// The abstract of "Influence of different haptic environments on time delay discrimination".
inline constexpr Limit kDelayUnnoticed{36, "ms", "cited: people notice the delay of a spring from 36 ms on"};

// How long contact may be lost.
inline Limit lostForFrames(double frames_per_s) {
  return {1.5e3 / frames_per_s, "ms", "derived: a method that holds frames is one period late; half of one is slack"};
}

}  // namespace relievo::scenario
