// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/depth_reading.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/media/reading/picture_look.h"
#include "app/scene/height_field.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;

// A depth rendering stretched to 16 bits reaches the upper half of the codes; 32 m in millimetres does not.
constexpr std::uint32_t kStretched = 0x8000;
// Among the codes in use, a sensor leaves a gap between its hole code (0) and its nearest reading.
constexpr std::uint32_t kLeastGap = 100;
constexpr double kHolesOfSensor = 0.002;

// A Kinect's raw disparity: 11 bits, 2047 for a hole, z = 351.3 / (1092.5 - code) m (Stowers, Hayes and
// Bainbridge-Smith, "Altitude control of a quadrotor helicopter using depth map from Microsoft Kinect sensor", 2011).
constexpr std::uint32_t kRawHole = 2047, kRawLowest = 300, kRawHighest = 1084;
constexpr double kRawMm = 351300, kRawOffset = 1092.5;

// Near and far are taken from all samples except outliers, with a margin because later pictures may show more.
constexpr double kOutliers = 0.002, kNearer = 0.9, kFarther = 1.1;

bool says(const CalibrationLayers& said, std::initializer_list<const char*> keys) {
  return std::any_of(keys.begin(), keys.end(), [&](const char* key) {
    return said.command_line.contains(key) || said.side_file.contains(key) || said.tags.contains(key);
  });
}

std::string number(double value) {
  return print("%.6g", value);
}

struct Reach {
  std::uint32_t low = 0, high = 0;
};
// The range of the codes between `lowest` and `highest`, without the outliers.
Reach reachOf(const CodeCount& count, std::uint32_t lowest, std::uint32_t highest) {
  return {count.quantile(kOutliers, lowest, highest), count.quantile(1 - kOutliers, lowest, highest)};
}

DepthReading rawKinect(const CodeCount& count) {
  const Reach reach = reachOf(count, kRawLowest, kRawHighest);
  const auto mm = [](double code) { return kRawMm / (kRawOffset - code); };
  const std::uint32_t low = reach.low, high = std::max(reach.high, reach.low + 1);
  DepthReading reading;
  reading.settings = {{"law", "inverse"},
                      {"polarity", "near-low"},
                      {"codes", std::to_string(low) + "-" + std::to_string(high)},
                      {"invalid", "0+1085-65535"},
                      {"near", number(mm(low))},
                      {"far", number(mm(high))}};
  reading.why = print("codes of %u to %u with holes of 2047: raw Kinect disparities, %.2f to %.2f m", low, high,
                      1e-3 * mm(low), 1e-3 * mm(high));
  return reading;
}

DepthReading distances(const CodeCount& count, double unit_mm, const char* what) {
  const Reach reach = reachOf(count, 1, kTop - 1);
  const double near = std::max(1.0, std::floor(kNearer * unit_mm * reach.low));
  const double far = std::max(near + 1, std::ceil(kFarther * unit_mm * reach.high));
  DepthReading reading;
  reading.settings = {{"unit", number(unit_mm)}, {"invalid", "0+65535"}, {"near", number(near)}, {"far", number(far)}};
  const double holes = 100 * (count.share(0, 0) + count.share(kTop, kTop));
  reading.why = print("codes of %u to %u with %.1f %% holes: %s, %.2f to %.2f m", reach.low, reach.high, holes, what,
                      1e-3 * unit_mm * reach.low, 1e-3 * unit_mm * reach.high);
  return reading;
}

bool isRawKinect(const CodeCount& count) {
  const double outside = count.share(1, kRawLowest - 1) + count.share(kRawHighest + 1, kRawHole - 1);
  return count.share(kRawHole + 1, kTop) == 0 && count.of(kRawHole) > 0 && outside < kOutliers &&
         count.share(kRawLowest, kRawHighest) > 0.05;
}

bool isDistances(const CodeCount& count) {
  if (count.share(1, kTop - 1) == 0) return false;
  if (count.quantile(1 - kOutliers, 1, kTop - 1) < kStretched) return true;
  return count.share(0, 0) > kHolesOfSensor && count.share(1, kLeastGap) == 0;
}

DepthReading readSensor(const CodeCount& count) {
  if (isRawKinect(count)) return rawKinect(count);
  if (count.step() > 8 || !isDistances(count)) return {};  // a format of fewer bits, stretched
  if (count.step() == 8) return distances(count, 0.125, "distances in mm, shifted left by 3 bits");
  return distances(count, 1, "distances in mm");
}

DepthReading readRange(const CodeCount& count) {
  constexpr double kBeyond = 0.005;  // more than coding errors make of black and white
  const std::uint32_t scale = 1u << (count.bits() - 8);
  const double beyond = count.share(0, 12 * scale) + count.share(240 * scale, 256 * scale - 1);
  if (beyond < kBeyond) return {};
  return {{{"range", "full"}}, print("%.1f %% of the codes lie outside of 16 to 235: full range", 100 * beyond)};
}

}  // namespace

CodeCount::CodeCount(const Frame& depth) : bits_(std::max<int>(8, depth.components[0].bits)) {
  of_code_.assign(std::size_t{1} << bits_, 0);
  const Component& k = depth.components[depth.model == ColorModel::Rgb ? 1 : 0];
  const Plane& plane = depth.planes[k.plane];
  for (int r = 0; r < depth.height; ++r) {
    const std::uint8_t* at = plane.data + r * plane.stride_bytes + k.offset_bytes;
    for (int c = 0; c < depth.width; ++c, at += k.step_bytes) ++of_code_[codeAt(k, at) & (of_code_.size() - 1)];
  }
  samples_ = static_cast<std::uint64_t>(depth.width) * static_cast<std::uint64_t>(depth.height);
}

double CodeCount::share(std::uint32_t low, std::uint32_t high) const {
  high = std::min<std::uint32_t>(high, static_cast<std::uint32_t>(of_code_.size()) - 1);
  if (low > high || samples_ == 0) return 0;
  const auto sum = std::accumulate(of_code_.begin() + low, of_code_.begin() + high + 1, std::uint64_t{0});
  return static_cast<double>(sum) / static_cast<double>(samples_);
}

std::uint32_t CodeCount::quantile(double q, std::uint32_t low, std::uint32_t high) const {
  high = std::min<std::uint32_t>(high, static_cast<std::uint32_t>(of_code_.size()) - 1);
  double left = q * share(low, high) * static_cast<double>(samples_);
  for (std::uint32_t code = low; code <= high; ++code) {
    if (of_code_[code] == 0) continue;
    left -= static_cast<double>(of_code_[code]);
    if (left <= 0) return code;
  }
  return low;
}

std::uint32_t CodeCount::step() const {
  std::uint32_t step = 0;
  for (std::uint32_t code = 0; code < of_code_.size(); ++code) {
    if (of_code_[code] > 0 && code != kTop) step = std::gcd(step, code);
  }
  return step;
}

DepthReading readCodes(const Frame& depth, const CodeCount& count, const CalibrationLayers& said) {
  if (depth.model == ColorModel::Yuv && depth.range == ColorRange::Unspecified) {
    return says(said, {"range", "unit", "codes"}) ? DepthReading{} : readRange(count);
  }
  const bool settled = says(said, {"law", "polarity", "range", "codes", "unit"});
  if (depth.model != ColorModel::Gray || count.bits() != 16 || settled) return {};
  return readSensor(count);
}

std::vector<std::string> doubtsOf(const Frame& depth, const DepthCalibration& calibration) {
  constexpr double kLeastRelief = 0.05, kOneCode = 0.95, kClipped = 0.1, kColored = 0.2;
  const auto field = HeightField::make(depth, calibration, {.width_mm = 1, .height_mm = 1, .depth_mm = 1});
  std::vector<std::string> doubts;
  if (!field) return doubts;
  std::vector<float> heights;
  std::uint64_t bottom = 0, top = 0;
  for (int r = 0; r < field->rows(); ++r) {
    for (int c = 0; c < field->cols(); ++c) {
      const double height = field->heightMm(c, r);
      if (std::isnan(height)) continue;
      heights.push_back(static_cast<float>(height));
      bottom += height <= 0 ? 1 : 0;
      top += height >= 1 ? 1 : 0;
    }
  }
  if (heights.empty()) {
    doubts.emplace_back("the whole depth picture is holes, so nothing can be felt: check --calibration invalid=");
    return doubts;
  }
  const auto count = static_cast<double>(heights.size());
  const auto at = [&](double q) {
    const auto nth = heights.begin() + static_cast<std::ptrdiff_t>(q * (count - 1));
    std::nth_element(heights.begin(), nth, heights.end());
    return static_cast<double>(*nth);
  };
  const double relief = at(0.995) - at(0.005), median = at(0.5);
  const double same =
      static_cast<double>(std::count(heights.begin(), heights.end(), static_cast<float>(median))) / count;
  const char* const range = "--calibration codes=LOW-HIGH, or unit=MM,near=MM,far=MM for distances";
  if (same > kOneCode) {
    doubts.push_back(print("%.0f %% of the depth is one code: an empty picture, or not depth", 100 * same));
  } else if (relief < kLeastRelief) {
    doubts.push_back(print("the relief uses only %.1f %% of the box's depth: try %s", 100 * relief, range));
  } else if (const double clipped = static_cast<double>(std::max(bottom, top)) / count; clipped > kClipped) {
    doubts.push_back(print("%.0f %% of the depth lies at the %s end of its range and is flat: try %s", 100 * clipped,
                           top > bottom ? "near" : "far", range));
  }
  if (calibration.code == DepthCode::Luma && depth.model != ColorModel::Gray) {
    const double colored = 1 - lookAt(depth).gray;
    if (colored > kColored) {
      doubts.push_back(
          print("%.0f %% of the depth is coloured but read as brightness: try --depth-code hue", 100 * colored));
    }
  }
  return doubts;
}

}  // namespace relievo
