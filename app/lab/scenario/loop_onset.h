// SPDX-License-Identifier: Apache-2.0
// The stiffness above which a device no longer comes to rest on a still wall.
#pragma once

#include "app/lab/finger/hand_loop.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo {

// Uses the method's own force, without the limits of the haptic task, on a still and nearly level wall against which
// the device is pushed with 1 N at 1 kHz, and with proportionally more at a higher rate. Found by bisection; stiffness
// in N/mm, within 1 %. Nullopt if the device rests even at `most`.
[[nodiscard]] std::optional<double> loopOnset(const Challenger& challenger, const DeviceProfile& profile,
                                              double most_n_per_mm);

// How far the device still swings, mm, after it was released 0.2 mm off its rest position: in the last quarter of 2 s.
struct Swing {
  double before_mm = 0, last_mm = 0;  // in the third and in the last quarter
};
[[nodiscard]] Swing swingOnWall(const Challenger& challenger, const DeviceProfile& profile, double stiffness_n_per_mm);

}  // namespace relievo
