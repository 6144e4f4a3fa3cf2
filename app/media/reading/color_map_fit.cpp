// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/color_map_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/scene/color_curve.h"
#include "app/scene/color_samples.h"

namespace relievo {
namespace {

constexpr int kAcross = 128, kDown = 96;  // samples examined
constexpr double kOnCurve = 0.04, kLeastShare = 0.9;
constexpr double kLeastSpread = 0.02;  // standard deviation of the place on the curve: less is one colour
constexpr double kLeastLit = 0.02;     // share of the samples
constexpr double kBlack = 0.06;

// A gray picture lies on no curve but touches some; nearly all its samples have less chroma than this.
constexpr double kGrayChroma = 0.04, kGrayShare = 0.8;

std::vector<YuvColor> litSamples(const Frame& picture) {
  const ColorSamples colors(picture);
  const int across = std::min(kAcross, picture.width), down = std::min(kDown, picture.height);
  std::vector<YuvColor> lit;
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      const YuvColor color =
          colors.at((2 * i + 1) * picture.width / (2 * across), (2 * j + 1) * picture.height / (2 * down));
      if (std::hypot(color.y, color.u, color.v) > static_cast<float>(kBlack)) lit.push_back(color);
    }
  }
  return static_cast<double>(lit.size()) < kLeastLit * across * down ? std::vector<YuvColor>{} : lit;
}

std::optional<ColorMapFit> fit(DepthCode code, const std::vector<YuvColor>& lit) {
  const ColorCurve& curve = curveOf(code);
  std::vector<float> distances;
  double on_curve = 0, sum = 0, squares = 0;
  for (const YuvColor& color : lit) {
    const ColorCurve::Point point = curve.nearest(color);
    const auto s = static_cast<double>(point.s);
    distances.push_back(point.distance);
    sum += s;
    squares += s * s;
    if (static_cast<double>(point.distance) <= kOnCurve) ++on_curve;
  }
  const auto count = static_cast<double>(lit.size());
  const double spread = std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
  if (on_curve < kLeastShare * count || spread < kLeastSpread) return std::nullopt;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return ColorMapFit{code, static_cast<double>(*middle), on_curve / count};
}

}  // namespace

std::optional<ColorMapFit> bestColorMap(const Frame& picture) {
  if (picture.empty() || picture.model == ColorModel::Gray) return std::nullopt;
  const std::vector<YuvColor> lit = litSamples(picture);
  const auto gray = std::count_if(lit.begin(), lit.end(), [](const YuvColor& color) {
    return std::hypot(color.u, color.v) < static_cast<float>(kGrayChroma);
  });
  if (lit.empty() || static_cast<double>(gray) > kGrayShare * static_cast<double>(lit.size())) return std::nullopt;
  std::optional<ColorMapFit> best;
  for (const DepthCode code : kDepthCodes) {
    if (code == DepthCode::Luma) continue;
    const auto found = fit(code, lit);
    if (found && (!best || found->residual < best->residual)) best = found;
  }
  return best;
}

}  // namespace relievo
