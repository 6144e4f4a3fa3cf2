// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/float_reading.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "app/media/reading/codes/stragglers.h"
#include "app/media/reading/depth_doubts.h"
#include "platform/print.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;
constexpr double kOutliers = 0.002, kNearer = 0.9, kFarther = 1.1;
constexpr double kMmPerMetre = 1000;
constexpr double kFarthestMetres = 200;   // if half of the samples are beyond this, the numbers are millimetres
constexpr double kLeastCentimetres = 20;  // a scene that is nearer is rare
constexpr double kDepthBuffer = 0.5;      // most of a depth buffer's numbers are near 1
constexpr double kLeastMm = 1e-3, kMostMm = 1e9;
constexpr double kNearMm = 500;  // of disparities, whose scale is unknown
constexpr int kNames = 3;        // of a path, from its end

bool has(const CalibrationLayers& said, const char* key) {
  return said.command_line.contains(key) || said.side_file.contains(key) || said.tags.contains(key);
}

std::optional<double> unitIn(const CalibrationLayers& said) {
  const std::string* const text = said.find("unit");
  if (text == nullptr) return std::nullopt;
  double unit = 0;
  const auto read = std::from_chars(text->data(), text->data() + text->size(), unit);
  return read.ec == std::errc() && unit > 0 ? std::optional(unit) : std::nullopt;
}

// The codes in use, without outliers.
struct Reach {
  double low = 0, median = 0, high = 0, holes = 0;
  bool relative = false;
  DistanceReach distances;
  double value = 1, zero = 0;  // number = zero + value * code
};
Reach reachOf(const Frame& depth, const CodeCount& count) {
  const auto [low, high] = count.reach(kOutliers, 1, kTop);
  const std::uint32_t median = count.quantile(0.5, 1, kTop);
  return {static_cast<double>(low),
          static_cast<double>(median),
          static_cast<double>(high),
          count.share(0, 0),
          areRelative(count),
          distanceReach(count, 1, kTop),
          depth.value_per_code != 0 ? std::abs(depth.value_per_code) : 1,
          depth.value_at_zero};
}

std::string codeRange(double low, double high) {
  const auto first = static_cast<int>(std::clamp(std::floor(low), 1.0, kTop - 1.0));
  const auto last = static_cast<int>(std::clamp(std::ceil(high), first + 1.0, static_cast<double>(kTop)));
  return std::to_string(first) + "-" + std::to_string(last);
}

std::string described(const Reach& reach) {
  return print("numbers of %.4g to %.4g with %.1f %% holes", reach.zero + reach.value * reach.low,
               reach.zero + reach.value * reach.high, 100 * reach.holes);
}

// On both sides of 0, where no distance lies: larger is nearer in disparities and in heights.
DepthReading lifted(const Reach& reach) {
  DepthReading reading;
  reading.settings = {{"law", "linear"},
                      {"polarity", "near-high"},
                      {"codes", codeRange(kNearer * reach.low, reach.high + (1 - kNearer) * reach.low)},
                      {"invalid", "0"}};
  reading.why = described(reach) + ", on both sides of 0: relative disparities or heights";
  reading.offer = "if large numbers are far: --calibration polarity=near-low";
  return reading;
}

DepthReading distances(const Reach& reach, std::optional<double> stated_unit_mm) {
  const double value = reach.value;
  const bool metres = value * reach.median < kFarthestMetres;
  const double unit_mm = stated_unit_mm.value_or(value * (metres ? kMmPerMetre : 1));
  const double near = kNearer * unit_mm * reach.low;
  const auto farOf = [&](double high) { return kFarther * unit_mm * std::max(high, reach.low + 1); };
  const double far = farOf(reach.distances.high);
  DepthReading reading;
  if (std::min(unit_mm, near) < kLeastMm || far > kMostMm) {
    reading.settings = {
        {"polarity", "near-low"}, {"codes", codeRange(kNearer * reach.low, kFarther * reach.high)}, {"invalid", "0"}};
    reading.why = described(reach) + ": distances without a known unit";
    reading.offer = "if large numbers are near: --calibration polarity=near-high";
    return reading;
  }
  reading.settings = {
      {"unit", print("%.9g", unit_mm)}, {"invalid", "0"}, {"near", print("%.6g", near)}, {"far", print("%.6g", far)}};
  reading.doubt = stragglersLine(reach.distances, unit_mm, near, farOf(reach.high));
  const char* const unit = stated_unit_mm ? "" : metres ? " in m" : " in mm";
  reading.why = described(reach) + ": distances" + unit;
  if (stated_unit_mm) return reading;
  reading.offer = "if the numbers are disparities: --calibration law=inverse; if heights: --as heights";
  if (value * reach.median > kLeastCentimetres) reading.offer += "; if cm: --as unreal";
  if (value * reach.high > 1) return reading;
  reading.unsure = true;  // a room is farther away
  reading.offer +=
      value * reach.low > kDepthBuffer
          ? "; if they are a depth buffer's d: write near * far / (far - d * (far - near))"
          : "; if they are shares of a greatest distance, such as Habitat's 10 m: --calibration unit=10000";
  return reading;
}

DepthReading disparities(const Reach& reach, double top, const CalibrationLayers& said) {
  const double low = kNearer * reach.low, high = std::min(top, kFarther * std::max(reach.high, reach.low + 1));
  DepthReading reading;
  reading.settings = {{"polarity", "near-high"}, {"codes", codeRange(low, high)}, {"invalid", "0"}};
  const bool linear = reach.relative || reach.zero != 0;
  reading.settings["law"] = linear ? "linear" : "inverse";
  if (!linear && !has(said, "near") && !has(said, "far")) {
    reading.settings["near"] = print("%.6g", kNearMm);
    reading.settings["far"] = print("%.6g", kNearMm * high / low);
  }
  reading.why = described(reach) + (reach.relative ? ": relative disparities" : ": disparities");
  if (!has(said, "law") && !has(said, "polarity")) {
    reading.offer = "if the numbers are distances: --calibration unit=1000 (metres) or unit=1 (millimetres)";
  }
  return reading;
}

void scale(CalibrationSettings& settings, double value, double zero) {
  const auto unit = settings.find("unit");
  double mm = 0;
  if (unit != settings.end()) {
    const std::string& text = unit->second;
    if (std::from_chars(text.data(), text.data() + text.size(), mm).ec == std::errc()) {
      unit->second = print("%.9g", std::max(kLeastMm, mm * value));
    }
  }
  const auto codes = settings.find("codes");
  if (codes == settings.end()) return;
  if (const auto range = CodeSet::parseRange(codes->second)) {
    codes->second = codeRange((range->low - zero) / value, (range->high - zero) / value);
  }
}

double full(const Frame& depth, std::uint32_t code) {
  return std::abs(depth.value_per_code) * code;
}

// A sensor's 65535 that `count` leaves out is still in the picture.
double nearerBelowAsDistances(const Frame& depth, const CodeCount& count) {
  const auto [low, high] = count.reach(kOutliers, 1, kTop);
  DepthCalibration distances{.polarity = DepthPolarity::NearIsLow, .bits = 16, .invalid = 0};
  if (const auto full = fullCode(depth, CodeCount(depth)); full && count.of(*full) == 0)
    distances.invalid = CodeSet::parse(print("0+%u", *full)).value_or(CodeSet(0));
  distances.codes = CodeSet::Range{low, std::max(high, low + 1)};
  return nearerBelow(depth, distances);
}

// AirSim's "img_CAR_CAMERA_KIND_TIME.pfm": kinds 1 and 2 are distances, 4 is a disparity.
std::optional<bool> kindOfAirSim(std::string_view name) {
  const std::size_t time = name.rfind('_');
  if (!name.starts_with("img_") || !name.ends_with(".pfm") || time < 2 || name[time - 2] != '_') return std::nullopt;
  const std::string_view digits = name.substr(time + 1, name.size() - time - 1 - std::string_view(".pfm").size());
  if (digits.empty() || digits.find_first_not_of("0123456789") != digits.npos) return std::nullopt;
  const char kind = name[time - 1];
  return kind == '4' ? std::optional(true) : kind == '1' || kind == '2' ? std::optional(false) : std::nullopt;
}

}  // namespace

std::optional<std::uint32_t> fullCode(const Frame& depth, const CodeCount& count) {
  constexpr double kClear = 0.98;  // a stereo camera's next step is farther off
  const double value = std::abs(depth.value_per_code);
  if (value == 0 || depth.value_at_zero != 0) return std::nullopt;
  const CodeCount all = count.together();
  for (const double number : {65.535, 65535.0}) {
    const double code = number / value;
    if (code < 2 || code > kTop) continue;
    const auto rounded = static_cast<std::uint32_t>(std::lround(code));
    const auto clear = static_cast<std::uint32_t>(kClear * code);
    const bool alone = all.share(clear, rounded - 1) == 0 && all.share(rounded + 1, kTop) == 0;
    if (all.of(rounded) > 0 && all.share(1, rounded - 1) > 0 && alone) return rounded;
  }
  return std::nullopt;
}

std::optional<bool> namesDisparity(std::string_view path) {
  const std::string lower = lowerCase(path);
  std::string_view rest = lower;
  const auto names = [](std::string_view name, auto words) {
    return std::any_of(words.begin(), words.end(), [&](const char* word) { return name.find(word) != name.npos; });
  };
  for (int i = 0; i < kNames && !rest.empty(); ++i) {
    const std::size_t slash = rest.rfind('/');
    const std::string_view name = slash == rest.npos ? rest : rest.substr(slash + 1);
    rest = slash == rest.npos ? std::string_view() : rest.substr(0, slash);
    if (names(name, std::array{"disp", "parallax", "inverse_depth", "invdepth", "inv_depth"})) return true;
    if (names(name, std::array{"depth", "dist", "zbuf"})) return false;
  }
  return kindOfAirSim(lower.substr(lower.rfind('/') + 1));
}

bool looksLikeDisparity(const Frame& depth, const CodeCount& count) {
  return nearerBelowAsDistances(depth, count) < -kClearlyNearer;
}

bool looksLikeDistance(const Frame& depth, const CodeCount& count) {
  return nearerBelowAsDistances(depth, count) > kClearlyNearer;
}

bool areRelative(const CodeCount& count) {
  constexpr double kMostRatio = 64;
  const auto [low, high] = count.reach(kOutliers, 1, kTop);
  return high > kMostRatio * low;
}

bool saysDisparity(std::string_view path) {
  constexpr std::array<std::string_view, 4> kWords{"disp", "disparity", "disparities", "disparitymap"};
  const auto says = [&](std::string_view name) {
    std::string word;
    for (const char c : std::string(name) + "/") {
      if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
        word += c;
      } else {
        if (std::ranges::find(kWords, word) != kWords.end()) return true;
        word.clear();
      }
    }
    return false;
  };
  const std::string lower = lowerCase(path);
  std::string_view rest = lower;
  for (int i = 0; i < kNames && !rest.empty(); ++i) {
    const std::size_t slash = rest.rfind('/');
    const std::string_view name = slash == rest.npos ? rest : rest.substr(slash + 1);
    rest = slash == rest.npos ? std::string_view() : rest.substr(0, slash);
    if (says(name)) return true;
    if (name.find("depth") != name.npos) return false;
  }
  return false;
}

// A network's numbers begin at 0.
bool areFromAfar(const Frame& depth, const CodeCount& count) {
  constexpr double kLeast = 0.1;
  const Reach reach = reachOf(depth, count);
  return count.share(1, kTop) > 0 && reach.zero + reach.value * reach.low >= kLeast;
}

bool mayBeMetres(const Frame& depth, const CodeCount& count) {
  constexpr double kMost = 16;  // a stereo camera's disparities reach more pixels
  const Reach reach = reachOf(depth, count);
  return areFromAfar(depth, count) && reach.value * reach.high <= kMost;
}

DepthReading readFloats(const Frame& depth, const CodeCount& count, bool disparity, const CalibrationLayers& said) {
  if (count.share(1, kTop) == 0) return {};
  if (const auto hole = fullCode(depth, count)) {
    DepthReading reading = readFloats(depth, count.without(CodeSet(*hole)), disparity, said);
    if (!reading.settings.empty()) reading.settings["invalid"] = print("0+%u", *hole);
    if (!reading.why.empty()) reading.why += print(", without %.5g, a sensor's 65535: holes", full(depth, *hole));
    return reading;
  }
  const Reach reach = reachOf(depth, count);
  const auto unit = unitIn(said);
  const bool told = !unit && (has(said, "law") || has(said, "polarity"));
  if (reach.zero != 0 && !told && !unit) return lifted(reach);
  if (told || (disparity && !unit)) return disparities(reach, (1u << count.bits()) - 1, said);
  DepthReading reading = distances(reach, unit);
  if (has(said, "near") || has(said, "far")) reading.doubt.clear();
  return reading;
}

void scaleToCodes(CalibrationLayers& said, const Frame& depth) {
  const double value = std::abs(depth.value_per_code);
  for (CalibrationSettings* layer : {&said.command_line, &said.side_file, &said.stated_kind, &said.tags, &said.names}) {
    scale(*layer, value, depth.value_at_zero);
  }
}

}  // namespace relievo
