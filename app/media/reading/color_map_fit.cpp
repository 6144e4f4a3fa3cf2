// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/color_map_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "app/media/reading/depth_reading.h"
#include "app/scene/color/color_curve.h"
#include "app/scene/color/color_samples.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr int kAcross = 128, kDown = 96;  // samples examined
constexpr double kOnCurve = 0.04, kLeastShare = 0.9;
constexpr double kLeastSpread = 0.02;  // standard deviation of the place on the curve: less is one colour
constexpr double kLeastLit = 0.02;     // share of the samples
constexpr double kBlack = 0.06;

// A gray picture lies on no curve but touches some; nearly all its samples have less chroma than this.
constexpr double kGrayChroma = 0.04, kGrayShare = 0.8;

// The matrices that a picture may be by. OpenCV and FFmpeg convert RGB by BT.601 however large it is, other programs by
// BT.709; many state neither.
std::vector<ColorMatrix> matricesOf(const Frame& picture) {
  if (picture.model != ColorModel::Yuv || picture.matrix != ColorMatrix::Unspecified) return {picture.matrix};
  return {ColorMatrix::Bt601, ColorMatrix::Bt709};
}

Frame byMatrix(Frame picture, ColorMatrix matrix) {
  picture.matrix = matrix;
  return picture;
}

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

// The median; `distances` are put in another order.
double middleOf(std::vector<float>& distances) {
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return static_cast<double>(*middle);
}

bool isGray(const std::vector<YuvColor>& lit) {
  const auto gray = std::ranges::count_if(
      lit, [](const YuvColor& color) { return std::hypot(color.u, color.v) < static_cast<float>(kGrayChroma); });
  return static_cast<double>(gray) > kGrayShare * static_cast<double>(lit.size());
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
  return ColorMapFit{code, middleOf(distances), on_curve / count};
}

// How many samples on the curve have each entry of the map, 0 to 255.
std::vector<double> entriesOf(const Frame& depth, DepthCode code) {
  constexpr int kMostAcross = 320;
  const ColorSamples colors(depth);
  const ColorCurve& curve = curveOf(code);
  const int step = 1 + (std::max(depth.width, depth.height) - 1) / kMostAcross;
  std::vector<double> entries(DepthCalibration::kMapHighest + 1);
  for (int r = 0; r < depth.height; r += step) {
    for (int c = 0; c < depth.width; c += step) {
      const ColorCurve::Point point = curve.nearest(colors.at(c, r));
      const auto entry = static_cast<std::size_t>(std::lround(point.s * DepthCalibration::kMapHighest));
      if (static_cast<double>(point.distance) <= kOnCurve) ++entries[entry];
    }
  }
  return entries;
}

}  // namespace

std::optional<ColorMapFit> bestColorMap(const Frame& picture) {
  if (picture.empty() || picture.model == ColorModel::Gray) return std::nullopt;
  std::optional<ColorMapFit> best;
  for (const ColorMatrix matrix : matricesOf(picture)) {
    const std::vector<YuvColor> lit = litSamples(byMatrix(picture, matrix));
    if (lit.empty() || isGray(lit)) return std::nullopt;
    for (const DepthCode code : kDepthCodes) {
      if (code == DepthCode::Luma) continue;
      const auto found = fit(code, lit);
      if (found && (!best || found->residual < best->residual)) best = found;
    }
  }
  return best;
}

ColorMatrix matrixOf(const Frame& depth, DepthCode code) {
  const std::vector<ColorMatrix> matrices = matricesOf(depth);
  if (matrices.size() == 1 || code == DepthCode::Luma) return depth.matrix;
  const ColorCurve& curve = curveOf(code);
  ColorMatrix best = depth.matrix;
  double least = std::numeric_limits<double>::infinity();
  for (const ColorMatrix matrix : matrices) {
    std::vector<float> distances;
    for (const YuvColor& color : litSamples(byMatrix(depth, matrix)))
      distances.push_back(curve.nearest(color).distance);
    const double residual = distances.empty() ? least : middleOf(distances);
    if (residual < least) best = matrix;
    least = std::min(least, residual);
  }
  return best;
}

DepthReading readColorMap(const Frame& depth, DepthCode code, const CalibrationLayers& said) {
  constexpr double kHoles = 0.002, kTimes = 4;
  const bool has_black = code == DepthCode::Kinect;  // for holes
  if (depth.model == ColorModel::Gray || has_black || says(said, {"invalid"})) return {};
  std::vector<double> entries = entriesOf(depth, code);
  const double all = std::accumulate(entries.begin(), entries.end(), 0.0);
  // Other programs' maps differ by an entry, coding smears by three; the entries beyond are then nearly unused.
  const std::ptrdiff_t smear = depth.model == ColorModel::Yuv ? 3 : 1, gap = 4 * smear;
  DepthReading reading;
  double most = kHoles * all;
  for (const bool last : {false, true}) {
    const double end = std::accumulate(entries.begin(), entries.begin() + smear + 1, 0.0);
    const double beyond = std::accumulate(entries.begin() + smear + 1, entries.begin() + smear + gap + 1, 0.0);
    std::ranges::reverse(entries);
    if (end <= most || kTimes * beyond >= end) continue;
    most = end;
    const int highest = DepthCalibration::kMapHighest, wide = static_cast<int>(smear);
    const std::string holes = last ? print("%d-%d", highest - wide, highest) : print("0-%d", wide);
    const std::string seen =
        print("%.1f %% at the colour map's %s, apart from the others", 100 * end / all, last ? "end" : "beginning");
    // A network's film has a sky there, and no holes.
    if (depth.model == ColorModel::Yuv) {
      reading.offer = print("%s; if they are holes: --calibration invalid=%s", seen.c_str(), holes.c_str());
      continue;
    }
    reading.settings["invalid"] = holes;
    reading.why = seen + ": holes";
    reading.offer = "if they are none: --calibration invalid=none";
  }
  return reading;
}

}  // namespace relievo
