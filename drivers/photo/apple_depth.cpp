// SPDX-License-Identifier: Apache-2.0
#include "drivers/photo/apple_depth.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "drivers/photo/jpeg_xmp.h"
#include "platform/print.h"

namespace relievo::photo {
namespace {

constexpr double kMmPerMetre = 1000;
constexpr double kMostRatio = 64;  // of far to near; smaller disparities are cut to it

constexpr const char* kType = "apdi:AuxiliaryImageType";

}  // namespace

std::optional<DepthRange> appleRange(std::string_view xmp) {
  const auto number = [&](const char* name) {
    const std::string word(property(xmp, name).value_or(""));
    return word.empty() ? std::nan("") : std::strtod(word.c_str(), nullptr);
  };
  const DepthRange range{number("apdi:FloatMinValue"), number("apdi:FloatMaxValue"),
                         property(xmp, kType).value_or("") == "depth"};
  return range.high > range.low ? std::optional(range) : std::nullopt;
}

bool isAppleDepth(std::string_view xmp) {
  const std::string_view type = property(xmp, kType).value_or("");
  return (type == "disparity" || type == "depth") && !property(xmp, "apdi:AuxiliaryImageSubType");
}

std::map<std::string, std::string> depthTags(const std::optional<DepthRange>& range, int bits) {
  std::map<std::string, std::string> tags{{"TITLE", "depth"},
                                          {"DEPTH_LAW", "inverse"},
                                          {"DEPTH_POLARITY", "near-high"},
                                          {"DEPTH_RANGE", "full"},
                                          {"DEPTH_INVALID", "none"}};
  if (!range || !std::isfinite(range->low) || !std::isfinite(range->high)) return tags;
  if (range->distances) {
    const auto [near, far] = std::minmax(range->low, range->high);
    tags["DEPTH_LAW"] = "linear";
    if (near == range->low) tags["DEPTH_POLARITY"] = "near-low";
    tags["DEPTH_NEAR"] = print("%.9g", kMmPerMetre * near);
    tags["DEPTH_FAR"] = print("%.9g", kMmPerMetre * far);
    return tags;
  }
  if (!(range->high > std::max(range->low, 1e-5))) return tags;
  const double least = range->high / kMostRatio;
  double low = range->low;
  if (low < least) {  // the codes below it are as far
    const double top = std::ldexp(1.0, std::clamp(bits, 8, 16)) - 1;
    const double code = std::min(top - 1, std::round(top * (least - low) / (range->high - low)));
    low += code / top * (range->high - low);
    tags["DEPTH_CODES"] = print("%.0f-%.0f", code, top);
  }
  tags["DEPTH_NEAR"] = print("%.9g", kMmPerMetre / range->high);
  tags["DEPTH_FAR"] = print("%.9g", kMmPerMetre / std::max(low, 1e-6));
  return tags;
}

}  // namespace relievo::photo
