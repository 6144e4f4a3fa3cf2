// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/codes/measured_codes.h"

#include <algorithm>
#include <cstddef>
#include <vector>

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

bool beginsNearerThanKinectSees(const CodeCount& count) {
  constexpr double kFew = 0.05;
  constexpr std::uint32_t kLeast = 1750;
  return count.quantile(kFew, 1, kTop - 1) < kLeast;
}

bool isTooNearForKinect(const CodeCount& count) {
  return beginsNearerThanKinectSees(count) && count.quantile(0.5, 1, kTop - 1) <= kMiddleMm;
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

std::optional<double> stereoConstant(const CodeCount& count) {
  constexpr std::uint64_t kLeastSamples = 4;  // of a distance; fewer are made between two others
  constexpr std::uint32_t kLeastStep = 4;     // rounding to whole codes hides smaller ones
  constexpr std::size_t kFewest = 40;
  constexpr double kSame = 1.3;
  if (count.bits() != 16) return std::nullopt;
  std::vector<double> constants;
  std::uint32_t nearer = 0;
  for (std::uint32_t code = 1; code < kTop; ++code) {
    if (count.of(code) < kLeastSamples) continue;
    if (nearer > 0 && code - nearer >= kLeastStep)
      constants.push_back(static_cast<double>(code) * nearer / (code - nearer));
    nearer = code;
  }
  if (constants.size() < kFewest) return std::nullopt;
  std::ranges::sort(constants);
  const std::size_t quarter = constants.size() / 4;
  const bool same = constants[constants.size() - 1 - quarter] <= kSame * constants[quarter];
  return same ? std::optional(constants[constants.size() / 2]) : std::nullopt;
}

const KnownKind* kindBySteps(const CodeCount& count, int cols) {
  struct Constants {
    double least, most;
  };
  constexpr Constants kMm{2.5e5, 1.7e6}, kTum{1.78e6, 1.92e6}, kTenths{2.15e6, 3.8e6};
  constexpr int kKinectCols = 640;
  const auto constant = stereoConstant(count);
  const auto within = [&constant](const Constants& range) {
    return constant && *constant >= range.least && *constant <= range.most;
  };
  if (within(kMm)) return findKind("mm");
  if (within(kTum) && cols <= kKinectCols) return findKind(beginsNearerThanKinectSees(count) ? "mm" : "tum");
  return within(kTenths) ? findKind("ycb") : nullptr;
}

}  // namespace relievo
