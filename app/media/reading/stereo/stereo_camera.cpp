// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/stereo/stereo_camera.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "platform/files/answered_place.h"
#include "platform/print.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;
constexpr double kOutliers = 0.002, kLower = 0.9, kHigher = 1.1;
constexpr double kMostMm = 1e9;

// The number in a line "name=number" or "name=[number ..".
std::optional<double> numberIn(const std::string& text, std::string_view name) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
    const std::size_t equals = at + name.size();
    if ((at > 0 && text[at - 1] != '\n') || equals >= text.size() || text[equals] != '=') continue;
    const char* const begin = text.c_str() + equals + (text[std::min(equals + 1, text.size() - 1)] == '[' ? 2 : 1);
    char* end = nullptr;
    const double value = std::strtod(begin, &end);
    return end != begin && std::isfinite(value) ? std::optional(value) : std::nullopt;
  }
  return std::nullopt;
}

// Pixels of disparity in one code.
double pixelsPerCode(const Frame& depth, const CodeCount& count, const StereoCamera& camera) {
  constexpr double kFine = 256;
  if (depth.value_per_code != 0) return std::abs(depth.value_per_code);
  const double highest = count.quantile(1 - kOutliers, 1, kTop);
  const bool too_many = camera.most > 0 ? highest > kHigher * camera.most : count.bits() > 8;
  return too_many && highest > kFine ? 1 / kFine : 1;
}

}  // namespace

std::optional<StereoCamera> stereoCameraIn(const std::filesystem::path& file) {
  if (!isRegularFile(file.string())) return std::nullopt;
  const auto text = readWholeFile(file.string(), FileSize::Settings, "cannot be read");
  if (!text) return std::nullopt;
  const auto number = [&](const char* name) { return numberIn(*text, name).value_or(0); };
  StereoCamera camera{.focal_px = number("cam0"),
                      .baseline_mm = number("baseline"),
                      .offset_px = number("doffs"),
                      .width_px = number("width"),
                      .least = number("vmin"),
                      .most = number("vmax")};
  if (camera.focal_px <= 0 || camera.baseline_mm <= 0) return std::nullopt;
  if (camera.least <= 0 || camera.most <= camera.least) camera.least = camera.most = 0;
  return camera;
}

StereoCamera stereoCameraOf2006(const std::filesystem::path& dmin_file) {
  StereoCamera camera{.focal_px = 3740, .baseline_mm = 160};
  const auto text = isRegularFile(dmin_file.string())
                        ? readWholeFile(dmin_file.string(), FileSize::Settings, "cannot be read")
                        : Result<std::string>(std::unexpected(Error{}));
  const double least = text ? std::strtod(text->c_str(), nullptr) : 0;
  if (least > 0 && std::isfinite(least)) camera.offset_px = least;
  return camera;
}

DepthReading readDisparities(const Frame& depth, const CodeCount& count, const StereoCamera& camera) {
  if (count.share(1, kTop) == 0) return {};
  // Pictures of another size have disparities of another size.
  const double size = camera.width_px > 0 ? depth.width / camera.width_px : 1;
  StereoCamera here = camera;
  for (double* px : {&here.focal_px, &here.offset_px, &here.least, &here.most}) *px *= size;
  const double pixels = pixelsPerCode(depth, count, here);
  const CodeCount::Reach reach = count.reach(kOutliers, 1, kTop);
  const double first = here.most > 0 ? here.least / pixels : kLower * reach.low;
  const double last = here.most > 0 ? here.most / pixels : kHigher * reach.high;
  const double low = std::clamp(std::floor(first), 1.0, kTop - 1.0);
  const double high = std::clamp(std::ceil(last), low + 1, static_cast<double>((1u << count.bits()) - 1));
  const auto mm = [&](double code) { return here.baseline_mm * here.focal_px / (pixels * code + here.offset_px); };
  if (!(mm(high) > 0 && mm(low) > mm(high) && mm(low) < kMostMm)) return {};
  DepthReading reading;
  reading.settings = {
      {"codes", print("%.0f-%.0f", low, high)}, {"near", print("%.6g", mm(high))}, {"far", print("%.6g", mm(low))}};
  reading.why = print("disparities of %.4g to %.4g pixels: %.2f to %.2f m", pixels * low, pixels * high,
                      1e-3 * mm(high), 1e-3 * mm(low));
  return reading;
}

}  // namespace relievo
