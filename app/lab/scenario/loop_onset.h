// SPDX-License-Identifier: Apache-2.0
// From which stiffness on a device does not come to rest any more on a still wall.
#pragma once

#include "app/lab/finger/hand_loop.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo {

// The method's own force, without the limits of the haptic task, on a still and nearly level wall that the device is
// pushed against with 1 N, at another rate of the profile than 1 kHz with as many more. Found by halving; stiffness in
// N/mm, within 1 %. Nothing when it rests even at `most`.
[[nodiscard]] std::optional<double> loopOnset(const Challenger& challenger, const DeviceProfile& profile,
                                              double most_n_per_mm);

// How far the device still swings, mm, after it has been let go 0.2 mm off its rest: in the last quarter of 2 s.
struct Swing {
  double before_mm = 0, last_mm = 0;  // in the third and in the last quarter
};
[[nodiscard]] Swing swingOnWall(const Challenger& challenger, const DeviceProfile& profile, double stiffness_n_per_mm);

}  // namespace relievo
