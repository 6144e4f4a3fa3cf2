// SPDX-License-Identifier: Apache-2.0
// Depth that is coded as brightness.
#include <algorithm>
#include <initializer_list>

#include "app/media/reading/depth_reading.h"
#include "app/media/reading/sample_parts.h"
#include "platform/print.h"

namespace relievo {
namespace {

DepthReading readRange(const CodeCount& count) {
  constexpr double kBeyond = 0.005;  // more than coding errors make of black and white
  const std::uint32_t scale = 1u << (count.bits() - 8);
  const double beyond = count.share(0, 12 * scale) + count.share(240 * scale, 256 * scale - 1);
  if (beyond < kBeyond) return {};
  return {{{"range", "full"}},
          nullptr,
          print("%.1f %% of the codes lie outside of 16 to 235: full range", 100 * beyond),
          ""};
}

// For gray without lossy coding in which the codes just above 0 do not occur: black is then a hole.
void readBlack(const CodeCount& count, DepthReading& reading) {
  constexpr int kShades = 32;
  const std::uint32_t gap = (1u << count.bits()) / 128;
  if (count.kinds() < kShades || !count.hasGapAtZero(gap)) return;
  reading.settings["invalid"] = "0";
  reading.why = print("%.1f %% black, apart from the other shades: holes", 100 * count.share(0, 0));
  reading.offer = "if black is far away: --calibration invalid=none";
}

// For a film in which black is separate from the other shades: holes, if near is dark. Coding smears black by a few
// codes.
std::string blackHoles(const CodeCount& count, bool full) {
  constexpr double kLeast = 0.002;
  const std::uint32_t scale = 1u << (count.bits() - 8);
  const std::uint32_t black = (full ? 2 : 18) * scale, gap = black + 4 * scale;
  const double share = count.share(0, black);
  if (share <= kLeast || 4 * count.share(black + 1, gap) > share) return "";
  return print("; if it is dark and black is a hole: --calibration polarity=near-low,invalid=0-%u", black + scale);
}

// How much brighter the upper third of the picture is than the lower one, as a share of all shades.
double brighterAbove(const Frame& depth) {
  const int third = depth.height / 3;
  const double white = (1u << depth.components[0].bits) - 1;
  if (third == 0) return 0;
  const auto meanOf = [&](int first) {
    double sum = 0;
    for (int r = first; r < first + third; ++r) {
      for (int c = 0; c < depth.width; ++c) sum += partAt(depth, 0, c, r);
    }
    return sum / (white * third * depth.width);
  };
  return meanOf(0) - meanOf(depth.height - third);
}

}  // namespace

bool says(const CalibrationLayers& said, std::initializer_list<const char*> keys) {
  return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return said.find(key) != nullptr; });
}

DepthReading readShades(const Frame& depth, const CodeCount& count, const CalibrationLayers& said) {
  const bool film = depth.model == ColorModel::Yuv, no_holes_said = !says(said, {"invalid"});
  DepthReading reading;
  if (film && depth.range == ColorRange::Unspecified && !says(said, {"range", "codes"})) reading = readRange(count);
  if (!film && no_holes_said) readBlack(count, reading);
  if (says(said, {"polarity", "unit", "law"})) return reading;
  if (!reading.offer.empty()) reading.offer += "; ";
  constexpr double kClearly = 0.15;
  // The ground is nearer below in most views.
  reading.offer += brighterAbove(depth) > kClearly
                       ? "near is taken to be bright, but the picture is brighter above than below, as if near were "
                         "dark: --calibration polarity=near-low"
                       : "near is taken to be bright; if it is dark: --calibration polarity=near-low";
  const bool full = depth.range == ColorRange::Full || reading.settings.contains("range");
  if (film && no_holes_said) reading.offer += blackHoles(count, full);
  return reading;
}

}  // namespace relievo
