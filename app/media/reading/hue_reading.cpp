// SPDX-License-Identifier: Apache-2.0
// Reads depth that is coded as a hue: red is both ends of the circle, so that it is a hole where other hues keep away
// from it.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "app/media/reading/depth_reading.h"
#include "app/scene/color/color_curve.h"
#include "app/scene/color/color_samples.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr int kSteps = DepthCalibration::kHueSteps;
constexpr int kRed = 32, kBeside = 64;  // steps of hue around red, which coding smears
// Record3D's film may hold distances up to its farthest, just before red: coding moves a hue by half of this.
constexpr int kFarRed = 12;
constexpr float kOffHues = 0.06F;
constexpr double kRedShare = 0.005;
constexpr double kOutliers = 0.01, kNearer = 0.9, kFarther = 1.1;

struct HueCount {
  std::array<std::uint64_t, kSteps + 1> of{};
  std::uint64_t lit = 0;

  // Counts red, too, although it is a hole in a relief.
  explicit HueCount(const Frame& depth) {
    const ColorSamples colors(depth);
    const ColorCurve& curve = curveOf(DepthCode::Hue);
    for (int r = 0; r < depth.height; ++r) {
      for (int c = 0; c < depth.width; ++c) {
        const ColorCurve::Point point = curve.nearest(colors.at(c, r));
        if (point.distance > kOffHues) continue;
        ++of[static_cast<std::size_t>(kSteps * point.s)];
        ++lit;
      }
    }
  }
  [[nodiscard]] std::uint64_t within(int low, int high) const {
    std::uint64_t sum = 0;
    for (int code = low; code <= high; ++code) sum += of[static_cast<std::size_t>(code)];
    return sum;
  }
  // Within `steps` of red.
  [[nodiscard]] std::uint64_t red(int steps) const { return within(0, steps) + within(kSteps - steps, kSteps); }
  // The quantile `q` of the hues that are not red.
  [[nodiscard]] int quantile(double q) const {
    constexpr int kEnd = kSteps - kFarRed;
    double left = q * static_cast<double>(within(kRed + 1, kEnd - 1));
    for (int code = kRed + 1; code < kEnd; ++code) {
      left -= static_cast<double>(of[static_cast<std::size_t>(code)]);
      if (left <= 0) return code;
    }
    return kEnd;
  }
};

// The hues in use fill the box; near and far become theirs.
void readReach(const HueCount& count, std::span<const Frame> later, HueSpan span, DepthReading& reading) {
  int least = count.quantile(kOutliers), most = count.quantile(1 - kOutliers);
  for (const Frame& picture : later) {
    const HueCount of_later(picture);
    if (of_later.lit == of_later.red(kRed)) continue;
    least = std::min(least, of_later.quantile(kOutliers));
    most = std::max(most, of_later.quantile(1 - kOutliers));
  }
  const int low = std::max(kRed + 1, static_cast<int>(kNearer * least));
  const int high = std::min(kSteps - kFarRed - 1, static_cast<int>(std::ceil(kFarther * most)));
  if (high <= low) return;
  const auto mm = [&](int code) { return span.near_mm + (span.far_mm - span.near_mm) * code / kSteps; };
  reading.settings["codes"] = print("%d-%d", low, high);
  reading.settings["near"] = print("%.6g", mm(low));
  reading.settings["far"] = print("%.6g", mm(high));
  reading.why += print("; hues of %.2f to %.2f m", 1e-3 * mm(low), 1e-3 * mm(high));
}

}  // namespace

bool hasRed(const Frame& depth) {
  if (depth.model == ColorModel::Gray) return false;
  const HueCount count(depth);
  const std::uint64_t red = count.red(kRed);
  return static_cast<double>(red) > kRedShare * static_cast<double>(count.lit) && red < count.lit;
}

DepthReading readHues(const Frame& depth, const CalibrationLayers& said, const KnownKind* kind, HueSpan span,
                      std::span<const Frame> later) {
  if (depth.model == ColorModel::Gray) return {};
  const HueCount count(depth);
  const std::uint64_t red = count.red(kRed), beside = count.red(kBeside) - red;
  const bool record3d = kind != nullptr && kind->name == std::string_view("record3d");
  const bool apart = static_cast<double>(red) > kRedShare * static_cast<double>(count.lit) && 10 * beside < red;
  DepthReading reading;
  const bool unknown = kind == nullptr && said.find("polarity") == nullptr;
  if (unknown) reading.offer = "if hues are of 1/distance, red far: --as realsense-disparity";
  if (record3d) reading.settings["polarity"] = "near-low";
  const bool realsense = kind != nullptr && std::string_view(kind->name).starts_with("realsense");
  if ((unknown || realsense) && !says(said, {"near", "far"})) {
    reading.offer += print("%sif the distances are known: --calibration near=MM,far=MM", unknown ? "; " : "");
  }
  if (count.lit == red || (!record3d && !apart) || said.find("invalid") != nullptr) return reading;
  reading.settings["invalid"] = print("0-%d+%d-%d", kRed, kSteps - (record3d ? kFarRed : kRed), kSteps);
  reading.why = print("%.1f %% red, apart from the other hues: holes",
                      100 * static_cast<double>(red) / static_cast<double>(count.lit));
  const bool reach_said = said.find("codes") != nullptr || said.find("near") != nullptr || said.find("far") != nullptr;
  if (record3d && !reach_said) readReach(count, later, span, reading);
  return reading;
}

}  // namespace relievo
