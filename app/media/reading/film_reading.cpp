// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/film_reading.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "platform/print.h"

namespace relievo {
namespace {

const CalibrationPart* find(const FilmReading& reading, const char* key) {
  const auto part =
      std::find_if(reading.parts.begin(), reading.parts.end(), [&](const CalibrationPart& p) { return p.key == key; });
  return part == reading.parts.end() ? nullptr : &*part;
}

std::string where(const FilmReading& reading) {
  const CalibrationPart* const packing = find(reading, "packing");
  if (packing == nullptr) return "";
  if (packing->value == "sbs") return "right of the colour, ";
  if (packing->value == "tb") return "below the colour, ";
  if (packing->value == "sbs-depth-first") return "left of the colour, ";
  if (packing->value == "alpha") return "in the alpha channel, ";
  return packing->value == "tb-depth-first" ? "above the colour, " : "";
}

std::string what(const FilmReading& reading, const DepthCalibration& c) {
  if (const CalibrationPart* const kind = find(reading, "kind")) return kind->value;
  if (c.unit_mm) return print("distances of %g mm a code", *c.unit_mm);
  const std::string code = c.code == DepthCode::Luma  ? "brightness"
                           : c.code == DepthCode::Hue ? "hue"
                                                      : print("colour map %s", name(c.code));
  const bool near_high = c.polarity == DepthPolarity::NearIsHigh;
  if (c.code == DepthCode::Hue) return code + (near_high ? ", red far" : ", red near");
  if (c.code != DepthCode::Luma) return code + (near_high ? ", near at its end" : ", near at its beginning");
  return code + (near_high ? ", near bright" : ", near dark");
}

constexpr const char *kLikelyTag = "DEPTH_LIKELY", *kAssumedTag = "DEPTH_ASSUMED";

bool lists(const std::map<std::string, std::string>& tags, const char* tag, const std::string& key) {
  const auto found = tags.find(tag);
  return found != tags.end() && ("," + found->second + ",").find("," + key + ",") != std::string::npos;
}

// For distances, the unit determines law and polarity.
Certainty certaintyOf(const FilmReading& reading, const char* key) {
  const std::string_view word = key;
  const CalibrationPart* const unit = find(reading, "unit");
  const bool distances = unit != nullptr && unit->value != "none";
  const CalibrationPart* const part = distances && (word == "law" || word == "polarity") ? unit : find(reading, key);
  const Certainty own = part != nullptr ? certaintyOf(part->origin) : Certainty::Assumed;
  return distances ? std::max(own, certaintyOf(unit->origin)) : own;
}

}  // namespace

const char* name(Certainty certainty) noexcept {
  switch (certainty) {
    case Certainty::Said:
      return "said";
    case Certainty::Likely:
      return "likely";
    case Certainty::Assumed:
      return "assumed";
  }
  return "";
}

Certainty certaintyOf(CalibrationOrigin origin) noexcept {
  switch (origin) {
    case CalibrationOrigin::Name:
    case CalibrationOrigin::FirstPicture:
    case CalibrationOrigin::LikelyTags:
      return Certainty::Likely;
    case CalibrationOrigin::Default:
    case CalibrationOrigin::AssumedTags:
      return Certainty::Assumed;
    default:
      return Certainty::Said;
  }
}

std::map<std::string, std::string> certaintyTags(const FilmReading& reading) {
  std::map<std::string, std::string> tags;
  for (const char* key : {"law", "polarity", "near", "far"}) {
    const Certainty certainty = certaintyOf(reading, key);
    if (certainty == Certainty::Said) continue;
    std::string& keys = tags[certainty == Certainty::Likely ? kLikelyTag : kAssumedTag];
    keys += (keys.empty() ? "" : ",") + std::string(key);
  }
  return tags;
}

void markGuesses(const std::map<std::string, std::string>& tags, CalibrationChoice& choice) {
  choice.explanation.clear();
  for (CalibrationPart& part : choice.parts) {
    if (part.origin == CalibrationOrigin::ContainerTags) {
      if (lists(tags, kLikelyTag, part.key)) part.origin = CalibrationOrigin::LikelyTags;
      if (lists(tags, kAssumedTag, part.key)) part.origin = CalibrationOrigin::AssumedTags;
    }
    choice.explanation +=
        (choice.explanation.empty() ? "" : ", ") + part.key + "=" + part.value + " (" + name(part.origin) + ")";
  }
}

std::string plainLine(const FilmReading& reading, const DepthCalibration& c) {
  std::string line = "depth " + where(reading) + what(reading, c);
  const CalibrationPart* const near = find(reading, "near");
  if (near != nullptr && certaintyOf(near->origin) != Certainty::Assumed) {
    line += print(", %.2f to %.2f m", 1e-3 * c.near_mm, 1e-3 * c.far_mm);
  }
  line += c.invalid.empty() ? "" : ", holes " + c.invalid.text();
  const CalibrationPart* const kind = find(reading, "kind");
  auto best = kind != nullptr ? kind->origin : CalibrationOrigin::Default;
  for (const CalibrationPart& part : reading.parts) {
    const bool tells = part.key == "polarity" || (part.key == "unit" && part.value != "none");
    if (kind == nullptr && tells) best = std::min(best, part.origin);
  }
  return line + " (" + (best == CalibrationOrigin::Default ? "assumed" : name(best)) + ")";
}

std::vector<std::string> partLines(const FilmReading& reading) {
  std::vector<std::string> lines;
  lines.reserve(reading.parts.size());
  for (const CalibrationPart& part : reading.parts) {
    std::string line = part.key + "=" + part.value + ": " + name(part.origin);
    const bool says_how_sure =
        part.origin == CalibrationOrigin::LikelyTags || part.origin == CalibrationOrigin::AssumedTags;
    if (!says_how_sure) line += std::string(", ") + name(certaintyOf(part.origin));
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace relievo
