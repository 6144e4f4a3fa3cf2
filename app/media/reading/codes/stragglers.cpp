// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/codes/stragglers.h"

#include <algorithm>

#include "platform/print.h"

namespace relievo {

DistanceReach distanceReach(const CodeCount& count, std::uint32_t low, std::uint32_t high) {
  constexpr double kOutliers = 0.002, kStragglers = 0.01, kTimes = 2;
  const auto [lowest, farthest] = count.reach(kOutliers, low, high);
  const std::uint32_t usual = count.reach(kStragglers, low, high).high;
  if (farthest - lowest <= kTimes * (std::max(usual, lowest) - lowest)) return {lowest, farthest, farthest, 0};
  const CodeCount all = count.together();
  const double valid = all.share(low, high);
  return {lowest, usual, farthest, valid > 0 ? all.share(usual + 1, high) / valid : 0};
}

std::string stragglersLine(const DistanceReach& reach, double unit_mm, double near_mm, double far_mm) {
  if (reach.farthest == reach.high) return "";
  return print(
      "%.1f %% of the depth lies beyond %.4g m, far behind all else, and is felt at the far end; if it "
      "matters: --calibration near=%.6g,far=%.6g",
      100 * reach.beyond, 1e-3 * unit_mm * reach.high, near_mm, far_mm);
}

}  // namespace relievo
