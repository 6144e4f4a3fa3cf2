// SPDX-License-Identifier: Apache-2.0
// Parses and prints calibration settings, and merges the layers (command line, side file, tags, ..) by precedence.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "app/scene/depth_calibration.h"
#include "platform/text/number_in.h"

namespace relievo {
namespace {

// In order of application: `unit` (codes are distances) presets law and polarity.
constexpr std::array<const char*, 9> kKeys{"unit",  "law",     "polarity", "range", "bits",
                                           "codes", "invalid", "near",     "far"};
constexpr const char* kTagPrefix = "DEPTH_";

constexpr const char* kUnknownKey =
    "unknown calibration key; use law, polarity, range, bits, codes, invalid, unit, near, far";
constexpr const char* kBadValue =
    "bad calibration value; use law=linear|inverse polarity=near-high|near-low range=full|limited "
    "bits=8..16 codes=LOW-HIGH|none invalid=0+65535+2000-2047|none unit (or none), near and far in mm, 1e-3..1e9";
constexpr const char* kNoValue = "calibration is written KEY=VALUE,KEY=VALUE,..";
constexpr const char* kFarBeforeNear = "calibration has far <= near; give both in mm, far the larger";
constexpr const char* kUnitIsLinear =
    "calibration has both unit=, for distances, and another law than linear; leave one out";
constexpr const char* kUnitHasCodes =
    "calibration has both unit=, for distances from near to far, and codes=; leave codes= out";
constexpr const char* kUnitIsNearLow =
    "calibration has both unit=, for distances (low is near), and polarity=near-high; leave one out";
constexpr const char* kUnitIsLuma =
    "calibration has unit=, for distances, but the depth is coded as a hue from near to far; "
    "give near and far instead of unit";
constexpr const char* kTooManyBits = "bits= is more than the depth's samples have; leave bits= out of the calibration";
constexpr const char* kNoSuchCode =
    "calibration has a code (codes, invalid) that the depth's bits cannot hold; give one below 2^bits";
constexpr std::uint32_t kDarkestKinect = 8;  // a ramp's black (no depth), with what coding adds
constexpr double kNearestMm = 1e-3, kFarthestMm = 1e9;

std::string_view trim(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

// Sets one value; false if the key does not allow it.
bool apply(DepthCalibration& c, std::string_view key, std::string_view value) {
  if (key == "law") {
    if (value != "linear" && value != "inverse") return false;
    c.law = value == "linear" ? DepthLaw::Linear : DepthLaw::Inverse;
  } else if (key == "polarity") {
    if (value != "near-high" && value != "near-low") return false;
    c.polarity = value == "near-high" ? DepthPolarity::NearIsHigh : DepthPolarity::NearIsLow;
  } else if (key == "range") {
    if (value != "full" && value != "limited") return false;
    c.range = value == "full" ? ColorRange::Full : ColorRange::Limited;
  } else if (key == "bits") {
    const auto bits = numberIn<int>(value);
    if (!bits || *bits < 8 || *bits > 16) return false;
    c.bits = *bits;
  } else if (key == "invalid") {
    const auto set = CodeSet::parse(value);
    if (!set) return false;
    c.invalid = *set;
  } else if (key == "codes") {
    const auto range = value == "none" ? std::optional(CodeSet::Range{}) : CodeSet::parseRange(value);
    if (!range || (value != "none" && range->high == range->low)) return false;
    c.codes = value == "none" ? std::nullopt : range;
  } else if (key == "unit" && value == "none") {
    c.unit_mm.reset();
  } else {
    const auto mm = numberIn<double>(value);
    if (!mm || !(*mm >= kNearestMm && *mm <= kFarthestMm)) return false;
    if (key == "unit") {
      c.unit_mm = mm;
      c.law = DepthLaw::Linear;
      c.polarity = DepthPolarity::NearIsLow;
    } else {
      (key == "near" ? c.near_mm : c.far_mm) = *mm;
    }
  }
  return true;
}

std::string written(const DepthCalibration& c, std::string_view key) {
  char text[32];
  if (key == "law") return c.law == DepthLaw::Linear ? "linear" : "inverse";
  if (key == "polarity") return c.polarity == DepthPolarity::NearIsHigh ? "near-high" : "near-low";
  if (key == "range") return c.range == ColorRange::Limited ? "limited" : "full";
  if (key == "bits") return std::to_string(c.bits);
  if (key == "invalid") return c.invalid.text();
  if (key == "codes") return c.codes ? CodeSet(*c.codes).text() : "none";
  if (key == "unit" && !c.unit_mm) return "none";
  const double mm = key == "unit" ? *c.unit_mm : key == "near" ? c.near_mm : c.far_mm;
  const auto end = std::to_chars(text, text + sizeof text, mm).ptr;
  return {text, end};
}

// The first rule that the calibration breaks, or null.
const char* misfit(const DepthCalibration& c, int sample_bits) {
  if (c.bits > sample_bits) return kTooManyBits;
  if (c.code == DepthCode::Luma && std::max(c.invalid.highest(), c.codes ? c.codes->high : 0) >> c.bits != 0)
    return kNoSuchCode;
  return nullptr;
}

// If the codes are distances: the first rule for such codes that `c` breaks. Null if there is none.
const char* distanceMisfit(const DepthCalibration& c) {
  if (!c.unit_mm) return nullptr;
  if (c.code == DepthCode::Hue) return kUnitIsLuma;
  if (c.law == DepthLaw::Inverse) return kUnitIsLinear;
  if (c.polarity == DepthPolarity::NearIsHigh) return kUnitIsNearLow;
  return c.codes ? kUnitHasCodes : nullptr;
}

// The first contradiction between the settings that holds for any film, or null.
const char* contradiction(const CalibrationSettings& settings) {
  DepthCalibration c;
  c.bits = 16;
  for (const char* key : kKeys) {
    if (const auto said = settings.find(key); said != settings.end()) apply(c, key, said->second);
  }
  if (settings.contains("near") && settings.contains("far") && c.far_mm <= c.near_mm) return kFarBeforeNear;
  if (const char* wrong = distanceMisfit(c); wrong != nullptr) return wrong;
  return misfit(c, settings.contains("bits") ? c.bits : 16);
}

}  // namespace

Result<CalibrationSettings> parseCalibration(std::string_view text) {
  CalibrationSettings settings;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of(",\n");
    std::string_view item = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    item = trim(item.substr(0, item.find('#')));
    if (item.empty()) continue;
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos) return fail(ErrorCode::InvalidArgument, kNoValue);
    const std::string_view key = trim(item.substr(0, equals));
    const std::string_view value = trim(item.substr(equals + 1));
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
      return fail(ErrorCode::InvalidArgument, kUnknownKey);
    }
    DepthCalibration scratch;
    if (!apply(scratch, key, value)) return fail(ErrorCode::InvalidArgument, kBadValue);
    settings[std::string(key)] = value;
  }
  if (const char* wrong = contradiction(settings); wrong != nullptr) return fail(ErrorCode::InvalidArgument, wrong);
  return settings;
}

CalibrationSettings calibrationFromTags(const std::map<std::string, std::string>& tags) {
  CalibrationSettings settings;
  for (const char* key : kKeys) {
    std::string tag = kTagPrefix;
    for (const char* p = key; *p != '\0'; ++p) tag += static_cast<char>(std::toupper(static_cast<unsigned char>(*p)));
    const auto found = tags.find(tag);
    DepthCalibration scratch;
    if (found != tags.end() && apply(scratch, key, found->second)) settings[key] = found->second;
  }
  return settings;
}

std::map<std::string, std::string> calibrationTags(const DepthCalibration& calibration) {
  std::map<std::string, std::string> tags;
  for (const char* key : kKeys) {
    std::string tag = kTagPrefix;
    for (const char* p = key; *p != '\0'; ++p) tag += static_cast<char>(std::toupper(static_cast<unsigned char>(*p)));
    tags[tag] = written(calibration, key);
  }
  return tags;
}

std::array<CalibrationLayers::Layer, 7> CalibrationLayers::order() const noexcept {
  using enum CalibrationOrigin;
  return {{{CommandLine, &command_line},
           {SideFile, &side_file},
           {StatedKind, &stated_kind},
           {ContainerTags, &tags},
           {FileBeside, &beside},
           {Name, &names},
           {FirstPicture, &pictures}}};
}

const std::string* CalibrationLayers::find(const std::string& key) const {
  for (const Layer& layer : order()) {
    if (const auto found = layer.settings->find(key); found != layer.settings->end()) return &found->second;
  }
  return nullptr;
}

Result<CalibrationChoice> chooseCalibration(const CalibrationLayers& layers, const Frame& depth_frame, DepthCode code) {
  CalibrationChoice choice;
  DepthCalibration& c = choice.calibration;
  c.code = code;
  const int sample_bits = c.bits = std::max<int>(8, depth_frame.components[0].bits);
  const bool limited_by_nature = depth_frame.model == ColorModel::Yuv && depth_frame.range != ColorRange::Full;
  c.range = limited_by_nature || depth_frame.range == ColorRange::Limited ? ColorRange::Limited : ColorRange::Full;
  if (code != DepthCode::Luma) c.range = ColorRange::Full;
  if (code == DepthCode::Hue) c.polarity = DepthPolarity::NearIsLow;
  if (code == DepthCode::Kinect) c.invalid = CodeSet(CodeSet::Range{0, kDarkestKinect});
  const bool signalled = depth_frame.range != ColorRange::Unspecified;
  choice.origin = signalled ? CalibrationOrigin::StreamSignalling : CalibrationOrigin::Default;

  const auto refuse = [](CalibrationOrigin said_by, const char* wrong) {
    return fail(said_by == CalibrationOrigin::CommandLine ? ErrorCode::InvalidArgument : ErrorCode::Corrupt, wrong);
  };
  auto distances_by = CalibrationOrigin::Default;  // the highest layer that gave near or far
  for (const char* key : kKeys) {
    const bool from_stream = std::string_view(key) == "bits" || (std::string_view(key) == "range" && signalled);
    CalibrationOrigin said_by = from_stream ? CalibrationOrigin::StreamSignalling : CalibrationOrigin::Default;
    for (const auto& [origin, settings] : layers.order()) {
      const auto found = settings->find(key);
      if (found == settings->end()) continue;
      DepthCalibration with = c;
      if (!apply(with, key, found->second)) return refuse(origin, kBadValue);
      if (const char* wrong = misfit(with, sample_bits); wrong != nullptr) {
        if (origin == CalibrationOrigin::ContainerTags) continue;  // left over from an earlier encoding
        return refuse(origin, wrong);
      }
      c = with;
      said_by = origin;
      choice.origin = std::min(choice.origin, origin);
      break;
    }
    if (std::string_view(key) == "near" || std::string_view(key) == "far") {
      distances_by = std::min(distances_by, said_by);
    }
    choice.parts.push_back({key, written(c, key), said_by});
    if (!choice.explanation.empty()) choice.explanation += ", ";
    choice.explanation += std::string(key) + "=" + written(c, key) + " (" + name(said_by) + ")";
  }
  if (const char* wrong = distanceMisfit(c); wrong != nullptr) return refuse(choice.origin, wrong);
  if (c.far_mm <= c.near_mm) return refuse(distances_by, kFarBeforeNear);
  return choice;
}

}  // namespace relievo
