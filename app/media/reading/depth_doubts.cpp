// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/depth_doubts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/media/reading/depth_reading.h"
#include "app/media/reading/known_kind.h"
#include "app/media/reading/picture_look.h"
#include "app/media/reading/stereo/stereo_pair.h"
#include "app/scene/film_box.h"
#include "app/scene/height_field.h"
#include "platform/print.h"
#include "platform/quantile.h"

namespace relievo {
namespace {

constexpr double kOneCode = 0.95;  // share of the samples that are no holes

constexpr const char* kRange = "--calibration codes=LOW-HIGH, or unit=MM,near=MM,far=MM for distances";

// The heights of a depth picture, from 0 (far) to 1 (near), and the shares of them at either end.
struct Relief {
  std::vector<float> heights;  // without holes
  double at_bottom = 0, at_top = 0;

  explicit Relief(const HeightField& field) {
    for (int r = 0; r < field.rows(); ++r) {
      for (int c = 0; c < field.cols(); ++c) {
        const double height = field.heightMm(c, r);
        if (std::isnan(height)) continue;
        heights.push_back(static_cast<float>(height));
        at_bottom += height <= 0 ? 1 : 0;
        at_top += height >= 1 ? 1 : 0;
      }
    }
    if (heights.empty()) return;
    at_bottom /= count();
    at_top /= count();
  }
  [[nodiscard]] double count() const { return static_cast<double>(heights.size()); }
  [[nodiscard]] double quantile(double q) {
    const auto nth = heights.begin() + static_cast<std::ptrdiff_t>(q * (count() - 1));
    std::nth_element(heights.begin(), nth, heights.end());
    return static_cast<double>(*nth);
  }
  // Of the code that most samples have, if one is so frequent.
  [[nodiscard]] double sameShare() {
    const auto middle = static_cast<float>(quantile(0.5));
    return static_cast<double>(std::count(heights.begin(), heights.end(), middle)) / count();
  }
};

// The option for codes that are distances although they were stated to be brightness.
std::string likelyKind(const Frame& depth, const DepthCalibration& calibration) {
  if (calibration.unit_mm || calibration.code != DepthCode::Luma || depth.value_per_code != 0) return kRange;
  const KnownKind* const kind = sensorKind(depth, CodeCount(depth));
  if (kind == nullptr) return kRange;
  return print("--as %s; the codes look like %s", kind->name, kind->what);
}

std::string doubtRelief(const Frame& depth, const DepthCalibration& calibration) {
  constexpr double kLeastRelief = 0.05, kClipped = 0.1;
  const auto field = HeightField::make(depth, calibration, {.width_mm = 1, .height_mm = 1, .depth_mm = 1});
  if (!field) return "";
  Relief relief(*field);
  if (relief.heights.empty()) {
    return "the whole depth picture is holes, so nothing can be felt: check --calibration invalid=";
  }
  if (const double same = relief.sameShare(); same > kOneCode) {
    return print("%.0f %% of the depth is one code: an empty picture, or not depth", 100 * same);
  }
  if (const double used = relief.quantile(0.995) - relief.quantile(0.005); used < kLeastRelief) {
    return print("the relief uses only %.1f %% of the box's depth: try %s", 100 * used,
                 likelyKind(depth, calibration).c_str());
  }
  const double clipped = std::max(relief.at_bottom, relief.at_top);
  if (clipped <= kClipped) return "";
  return print("%.0f %% of the depth lies at the %s end of its range and is flat: try %s", 100 * clipped,
               relief.at_top > relief.at_bottom ? "near" : "far", likelyKind(depth, calibration).c_str());
}

// Depth has no colours, unless it is a colour map.
std::string doubtColor(const Frame& depth, const DepthCalibration& calibration, const Frame* color) {
  constexpr double kColored = 0.2, kGray = 0.99;
  if (calibration.code != DepthCode::Luma || depth.model == ColorModel::Gray) return "";
  const PictureLook look = lookAt(depth);
  const double colored = 1 - look.gray;
  if (colored <= kColored || 1 - lookAt(meansOf(depth)).gray <= kColored) return "";
  if (color != nullptr && lookAt(*color).gray >= kGray) {
    return print(
        "%.0f %% of the depth is coloured and the colour is gray: they look exchanged; give the other as --depth",
        100 * colored);
  }
  if (isHue(look))
    return print("%.0f %% of the depth is coloured but read as brightness: try --depth-code hue", 100 * colored);
  return print(
      "%.0f %% of the depth is coloured but read as brightness, and its colours are of no known map, so the relief is "
      "wrong: write the depth again in gray, preferably of 16 bits, or name its colour map: --depth-code turbo, ..",
      100 * colored);
}

// From black to white or back, in small steps, along one line of samples.
int swingsAlong(const Frame& depth, bool row, int line) {
  constexpr double kBlack = 0.1, kWhite = 0.9, kEdge = 0.25;
  const int length = row ? depth.width : depth.height;
  int swings = 0, end = 0;  // -1: black, 1: white, 0: none since an edge
  double before = 0;
  for (int i = 0; i < length; ++i) {
    const double shade = row ? colorAt(depth, i, line).green : colorAt(depth, line, i).green;
    const int here = shade < kBlack ? -1 : shade > kWhite ? 1 : 0;
    if (std::abs(shade - before) > kEdge) end = 0;
    if (here * end < 0) ++swings;
    if (here != 0) end = here;
    before = shade;
  }
  return swings;
}

std::string doubtPattern(const Frame& depth, const DepthCalibration& calibration) {
  constexpr int kLines = 64, kMany = 4;
  if (calibration.code != DepthCode::Luma || depth.components[0].bits != 8) return "";
  for (const bool row : {true, false}) {
    const int all = row ? depth.height : depth.width, lines = std::min(kLines, all);
    int swings = 0;
    for (int i = 0; i < lines; ++i) swings += swingsAlong(depth, row, (2 * i + 1) * all / (2 * lines));
    if (swings < kMany * lines) continue;
    return print(
        "the depth runs from black to white and back %d times along a line, as in RealSense's colour scheme Pattern: "
        "each shade means many distances, so the relief is wrong; record it with the scheme Hue or White to Black, or "
        "as .bag",
        swings / lines / 2);
  }
  return "";
}

// How far the codes bend, in the median, over a hundred and sixtieth of the picture's width on either side: in photos
// by 1.2 % of their range and more, in depth that a network or a stereo matcher has made by .4 % at most, as in a
// sensor's.
std::string doubtRoughness(const Frame& depth, const DepthCalibration& calibration) {
  constexpr int kLines = 64, kPlaces = 96;
  constexpr double kRough = 0.011, kLeastCodes = 3, kOutliers = 0.005;
  const int reach = std::max(1, depth.width / 160), step = 1 + depth.width / kPlaces;
  const auto field = HeightField::make(depth, calibration, {.width_mm = 1, .height_mm = 1, .depth_mm = 1});
  if (!field || calibration.code != DepthCode::Luma || calibration.bits != 8 || calibration.unit_mm) return "";
  std::vector<std::uint16_t> row(static_cast<std::size_t>(depth.width));
  std::vector<double> codes, bends;
  for (int r = 0; r < depth.height; r += 1 + depth.height / kLines) {
    if (!field->readCodes(r, row)) return "";
    for (int c = reach; c + reach < depth.width; c += step) {
      const double here = row[c];
      codes.push_back(here);
      bends.push_back(std::abs(row[c - reach] - 2 * here + row[c + reach]));
    }
  }
  const double range = quantile(codes, 1 - kOutliers) - quantile(codes, kOutliers), bend = quantile(bends, 0.5);
  if (bend < kLeastCodes || bend <= kRough * range) return "";
  return print(
      "the depth is as rough as a photo (%d samples apart it bends by %.0f of %.0f codes): check that it is the depth; "
      "if a sensor's noise makes it so, clean it with relievo-author --enhance space-time",
      reach, bend, range);
}

// Holes around an object follow its outline in the colour; a view has no such holes.
bool hasManyHoles(const Frame& depth, const DepthCalibration& calibration) {
  constexpr double kMany = 0.1;
  return !calibration.invalid.empty() && CodeCount(depth).share(calibration.invalid) > kMany;
}

// A --box of this aspect ratio, 160 mm on its longer side.
std::string boxOf(double aspect) {
  constexpr double kLong = 160;
  return print("%.0fx%.0fx40", std::min(kLong, kLong * aspect), std::min(kLong, kLong / aspect));
}

std::string doubtShape(const Frame& depth, const Frame& color) {
  constexpr double kSame = 0.03;
  const double ratio = shapeOf(depth) / shapeOf(color);
  if (std::abs(ratio - 1) <= kSame) return "";
  if (std::abs(shapeOf(depth) * shapeOf(color) - 1) <= kSame) {
    return print(
        "the colour is %.2f times as wide as high, the depth %.2f: one of them lies on its side; turn the depth, such "
        "as ffmpeg -i DEPTH -vf transpose=1 -c:v ffv1 TURNED.mkv (transpose=2: the other way round), and give it as "
        "--depth TURNED.mkv",
        shapeOf(color), shapeOf(depth));
  }
  const bool by_depth = hasShapeOfDepth(color, depth);
  return print(
      "the colour is %.2f times as wide as high, the depth %.2f: both are shown in the %s's shape; if the %s's is "
      "right, "
      "play it with --box %s; if one shows more than the other, give --registration",
      shapeOf(color), shapeOf(depth), by_depth ? "depth" : "colour", by_depth ? "colour" : "depth",
      boxOf(shapeOf(by_depth ? color : depth)).c_str());
}

}  // namespace

bool isLevel(const Frame& depth, const DepthCalibration& calibration) {
  const auto field = HeightField::make(depth, calibration, {.width_mm = 1, .height_mm = 1, .depth_mm = 1});
  if (!field) return false;
  Relief relief(*field);
  return relief.heights.empty() || relief.sameShare() > kOneCode;
}

double nearerBelow(const Frame& depth, const DepthCalibration& calibration) {
  constexpr int kMost = 64;  // rows of a third, and columns, that are examined
  const auto field = HeightField::make(depth, calibration, {.width_mm = 1, .height_mm = 1, .depth_mm = 1});
  const int third = depth.height / 3;
  if (!field || third == 0) return 0;
  const int step = 1 + (third - 1) / kMost, stride = 1 + (depth.width - 1) / kMost;
  const auto mean_of = [&](int first) {
    double sum = 0, count = 0;
    for (int r = first; r < first + third; r += step) {
      for (int c = 0; c < depth.width; c += stride) {
        const double height = field->heightMm(c, r);
        if (std::isnan(height)) continue;
        sum += height;
        ++count;
      }
    }
    return sum / count;
  };
  const double nearer = mean_of(depth.height - third) - mean_of(0);
  return std::isnan(nearer) ? 0 : nearer;
}

std::string nearEndLine(const DepthCalibration& calibration, double nearer_below, const std::string& black) {
  const char *high = "the colour map's end", *low = "the colour map's beginning";
  if (calibration.code == DepthCode::Luma) high = "bright", low = "dark";
  if (calibration.code == DepthCode::Hue) high = "the end of hues beyond blue", low = "red";
  const bool near_high = calibration.polarity == DepthPolarity::NearIsHigh;
  const char* view = "";
  if (nearer_below > kClearlyNearer) view = ", which makes the view nearer below than above, as most are";
  if (nearer_below < -kClearlyNearer) view = ", although the view is nearer above than below then, as few are";
  const std::string line =
      print("nothing says which end of the depth is near: %s is taken%s; if it is %s: --calibration polarity=%s",
            near_high ? high : low, view, near_high ? low : high, near_high ? "near-low" : "near-high");
  const bool may_be_mm = calibration.code == DepthCode::Luma && calibration.bits >= 12 && calibration.bits < 16;
  const std::string hole =
      near_high ? ",invalid=" + black + ", black being a hole" : ",invalid=none; black is a hole now";
  return line + (black.empty() ? "" : hole) + (may_be_mm ? "; if a code is 1 mm: --as mm" : "") +
         (may_be_mm && calibration.bits == EvenSteps::kBits ? "; if LeRobot wrote it: --as lerobot" : "");
}

std::vector<std::string> doubtsOf(const Frame& depth, const DepthCalibration& calibration, const Frame* color,
                                  bool by_author) {
  std::vector<std::string> doubts;
  const auto add = [&doubts](std::string doubt) {
    if (!doubt.empty()) doubts.push_back(std::move(doubt));
  };
  add(doubtRelief(depth, calibration));
  add(doubtPattern(depth, calibration));
  const bool whole = calibration.code == DepthCode::Luma && !hasManyHoles(depth, calibration);
  if (color != nullptr && whole && !by_author && areViews(*color, depth)) {
    add("colour and depth show the same picture: two views or a copy, not depth; check --depth");
  } else if (const std::string colored = doubtColor(depth, calibration, color); !colored.empty()) {
    add(colored);
  } else if (!by_author) {
    add(doubtRoughness(depth, calibration));
  }
  if (color != nullptr) add(doubtShape(depth, *color));
  return doubts;
}

}  // namespace relievo
