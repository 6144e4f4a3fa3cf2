// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/codes/measured_codes.h"

#include <algorithm>

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;

// A depth rendering stretched to 16 bits reaches the upper quarter of the codes; 32 m in mm, or 10 m at 5000 codes a
// metre, do not.
constexpr std::uint32_t kStretched = 0xc000;
constexpr std::uint32_t kLeastGap = 100;
constexpr double kOutliers = 0.002;

}  // namespace

bool isMeasured(const CodeCount& count) {
  constexpr int kLeastCodes = 100;
  return count.kinds() >= kLeastCodes;
}

bool isDistances(const CodeCount& count) {
  constexpr double kMost = 0.9;
  if (count.share(1, kTop - 1) == 0) return false;
  const std::uint32_t highest = count.quantile(1 - kOutliers, 1, kTop - 1);
  if (highest < kMaybeStretched) return true;
  const bool gap = count.hasGapAtZero(kLeastGap);
  if (highest < kStretched) return gap;
  // Wild distances, and a stereo camera's far noise, reach every code.
  return hasStereoSteps(count) || (gap && isMeasured(count) && count.quantile(kMost, 1, kTop - 1) < kFarthestMm);
}

bool isTooNearForKinect(const CodeCount& count) {
  return count.quantile(kOutliers, 1, kTop - 1) < kLeastOfFine && count.quantile(0.5, 1, kTop - 1) <= kMiddleMm;
}

bool hasStereoSteps(const CodeCount& count) {
  constexpr std::uint32_t kFirst = 0x2000, kLast = 0x8000;
  constexpr int kFewest = 4, kMost = 64;  // steps of a camera from 33 to 65 m: 5 to 50
  constexpr double kFewer = 1.5, kOfEach = 4;
  if (count.bits() != 16) return false;
  int nearer = 0;
  for (std::uint32_t low = kFirst; low <= kLast; low *= 2) {
    const int kinds = count.kinds(low, std::min(2 * low - 1, kTop - 1));
    if (kinds < kFewest || (nearer > 0 && kFewer * kinds > nearer)) return false;
    nearer = kinds;
  }
  const double samples = count.share(kLast, kTop - 1) * static_cast<double>(count.samples());
  return nearer <= kMost && samples >= kOfEach * nearer;
}

}  // namespace relievo
