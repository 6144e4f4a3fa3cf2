// SPDX-License-Identifier: Apache-2.0
// Depth that is coded as brightness.
#include <algorithm>
#include <initializer_list>

#include "app/media/reading/depth_reading.h"
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

// The codes of black in a film, if black is separate from the other shades. Coding smears black by a few codes.
std::string blackCodes(const CodeCount& count, bool full) {
  constexpr double kLeast = 0.002;
  const std::uint32_t scale = 1u << (count.bits() - 8);
  const std::uint32_t black = (full ? 2 : 18) * scale, gap = black + 4 * scale;
  const double share = count.share(0, black);
  if (share <= kLeast || 4 * count.share(black + 1, gap) > share) return "";
  return print("0-%u", black + scale);
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
  const bool full = depth.range == ColorRange::Full || reading.settings.contains("range");
  if (film && no_holes_said) reading.black = blackCodes(count, full);
  return reading;
}

}  // namespace relievo
