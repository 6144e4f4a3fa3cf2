// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/depth_reach.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hal/media/samples.h"
#include "platform/print.h"

namespace relievo {
namespace {

// The share and range of later pictures' depth beyond the range first read.
struct Beyond {
  int samples = 0, valid = 0, outside = 0;
  double low = 0, high = 0;  // the codes in use, without outliers
};

Beyond beyondIn(const Frame& depth, const DepthCalibration& calibration) {
  constexpr int kAcross = 96, kDown = 64;
  constexpr double kOutliers = 0.002;
  const int across = std::min(kAcross, depth.width), down = std::min(kDown, depth.height);
  const double low = calibration.lowCode(), high = calibration.highCode();
  std::vector<std::uint32_t> codes;
  codes.reserve(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  Beyond beyond;
  for (int j = 0; j < down; ++j) {
    const int r = (2 * j + 1) * depth.height / (2 * down);
    for (int i = 0; i < across; ++i) {
      const int c = (2 * i + 1) * depth.width / (2 * across);
      const auto code = codeAt(depth, brightnessOf(depth), c, r);
      if (calibration.invalid.contains(code)) continue;
      codes.push_back(code);
      if (code < low || code > high) ++beyond.outside;
    }
  }
  beyond.samples = across * down;
  beyond.valid = static_cast<int>(codes.size());
  if (codes.empty()) return beyond;
  std::ranges::sort(codes);
  const auto outliers = static_cast<std::size_t>(kOutliers * static_cast<double>(codes.size()));
  beyond.low = codes[outliers];
  beyond.high = codes[codes.size() - 1 - outliers];
  return beyond;
}

// The distance of a code beyond those of the calibration: the inverse law is linear in 1/distance.
double distanceOf(const DepthCalibration& c, double code) {
  const bool near_high = c.polarity == DepthPolarity::NearIsHigh;
  const double at_low = near_high ? c.far_mm : c.near_mm, at_high = near_high ? c.near_mm : c.far_mm;
  const double s = (code - c.lowCode()) / (c.highCode() - c.lowCode());
  if (c.law == DepthLaw::Inverse) return 1 / ((1 - s) / at_low + s / at_high);
  return at_low + s * (at_high - at_low);
}

// The option to type so that the codes of `beyond` are included. `value`: of a code, 1 unless codes stand for floats,
// whose own numbers the option takes; it takes none below 0.
std::string widerOption(const DepthCalibration& c, const Beyond& beyond, double value) {
  constexpr double kNearer = 0.9, kFarther = 1.1;
  const double low = std::min(beyond.low, c.lowCode()), high = std::max(beyond.high, c.highCode());
  if (c.unit_mm) {
    const double near = beyond.low < c.lowCode() ? kNearer * *c.unit_mm * low : c.near_mm;
    const double far = beyond.high > c.highCode() ? kFarther * *c.unit_mm * high : c.far_mm;
    return print("--calibration near=%.0f,far=%.0f", std::max(1.0, std::floor(near)), std::ceil(far));
  }
  const char* const law = c.law == DepthLaw::Inverse ? "inverse" : "linear";
  const char* const polarity = c.polarity == DepthPolarity::NearIsHigh ? "near-high" : "near-low";
  const double one = distanceOf(c, low), other = distanceOf(c, high);
  std::string option = print("--calibration law=%s,polarity=%s,codes=%.0f-%.0f", law, polarity, std::floor(value * low),
                             std::ceil(value * high));
  if (!c.invalid.empty()) option += ",invalid=" + c.invalid.text();
  if (std::min(one, other) > 0) option += print(",near=%.6g,far=%.6g", std::min(one, other), std::max(one, other));
  return option;
}

}  // namespace

std::optional<BeyondReach> beyondReach(const Frame& picture, const DepthCalibration& calibration) {
  constexpr double kTold = 0.02;
  if (calibration.code != DepthCode::Luma) return std::nullopt;
  const Beyond beyond = beyondIn(picture, calibration);
  if (beyond.outside <= kTold * beyond.samples) return std::nullopt;
  const double value = picture.value_per_code != 0 ? std::abs(picture.value_per_code) : 1;
  const bool lifted = picture.value_at_zero != 0;
  return BeyondReach{100.0 * beyond.outside / beyond.samples, lifted ? "" : widerOption(calibration, beyond, value)};
}

}  // namespace relievo
