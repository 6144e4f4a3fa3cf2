// SPDX-License-Identifier: Apache-2.0
// The rates at which the haptic task may tick, and the stiffness that stays stable at another rate.
#pragma once

#include "platform/realtime.h"

namespace relievo {

inline constexpr double kLeastRateHz = 500, kMostRateHz = 8000;

// Stiffness, N/mm, at which people began to feel a virtual wall as unstable: 0.325 at 250 Hz, 0.904 at 40 kHz (Choi and
// Tan, IROS 2004). Between and beyond these a power of the rate: 5 % more for each quarter more.
[[nodiscard]] double perceivedOnset(double rate_hz) RELIEVO_RT;

// For a device that is stable up to `known_n_per_mm` at `known_hz`. A lower rate lowers that in proportion: a wall K is
// passive while b > K T/2 + |B| (Colgate and Schenkel 1994), with forces late by whole ticks as well. A higher rate
// raises it only as perceivedOnset, since the bound of the encoder, 2 f_c/step, does not depend on the rate.
[[nodiscard]] double stiffnessAtRate(double known_n_per_mm, double known_hz, double rate_hz) RELIEVO_RT;

}  // namespace relievo
