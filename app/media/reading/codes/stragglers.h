// SPDX-License-Identifier: Apache-2.0
// The range of distances without the few that lie far behind all others.
#pragma once

#include <cstdint>
#include <string>

#include "app/media/reading/code_count.h"

namespace relievo {

// Sensors and networks return a few distances far behind the scene: through a window, at a rim, or wrong. With them at
// the far end, the shape would be pressed into a small part of the box; they are felt at the far end instead.
struct DistanceReach {
  std::uint32_t low = 0, high = 0;  // the codes in use, without outliers
  std::uint32_t farthest = 0;       // of the codes left out at the far end; `high` if none are
  double beyond = 0;                // the share of the valid samples that is left out
};
// Of the codes in `low` .. `high`, as CodeCount::reach; leaves out up to a hundredth of a picture's samples at the far
// end if the range of the others is less than half as wide.
[[nodiscard]] DistanceReach distanceReach(const CodeCount& count, std::uint32_t low, std::uint32_t high);

// What is left out, and the option that includes it; empty if nothing is. `unit_mm`: of a code; `near_mm`, `far_mm`: as
// they would be with it.
[[nodiscard]] std::string stragglersLine(const DistanceReach& reach, double unit_mm, double near_mm, double far_mm);

}  // namespace relievo
