// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/depth_meaning.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "app/media/reading/code_count.h"
#include "app/media/reading/codes/far_background.h"
#include "app/media/reading/codes/measured_codes.h"
#include "app/media/reading/depth_doubts.h"
#include "app/media/reading/depth_reading.h"
#include "app/media/reading/float_reading.h"
#include "app/media/reading/near_end.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Error kNoDistances{ErrorCode::InvalidArgument, 0,
                             "its numbers go through 0, so they are no distances; leave unit= out"};

constexpr const char* kAsTum =
    "names and lists are as TUM's, but at 5000 codes a metre it would begin nearer than a Kinect sees; if it does: "
    "--as tum";

// What was stated about the codes themselves; it overrides what names and pictures show.
CalibrationLayers saidLayers(const DepthClues& clues) {
  CalibrationLayers layers;
  layers.command_line = clues.command_line;
  layers.side_file = clues.side_file;
  layers.tags = calibrationFromTags(clues.tags);
  return layers;
}

// True if the pictures have the form of the kind.
bool fits(const KnownKind& kind, DepthCode code, const Frame& frame) {
  if (kind.code) return *kind.code == code;
  if (kind.order == SampleOrder::Steps) return code == DepthCode::Luma && frame.components[0].bits == EvenSteps::kBits;
  return frame.model == ColorModel::Gray && frame.components[0].bits == 16;
}

bool is(std::string_view name, const KnownKind* kind) {
  return kind != nullptr && kind->name == name;
}

// Others record in mm, too, and lay their files out as TUM does.
bool isOfMmAsTum(const DepthClues& clues, const Frame& stored, const CodeCount& count) {
  if (!is("tum", clues.place.kind) || clues.place.origin != CalibrationOrigin::Name) return false;
  const KnownKind* const kind = sensorKind(stored, count);
  return is("mm", kind) && (isTooNearForKinect(count.together()) || kindBySteps(count, stored.width) == kind);
}

// Record3D states the range of the whole circle of hues, of which a film uses a part.
HueSpan takeSpan(CalibrationSettings& settings) {
  HueSpan span;
  const auto take = [&settings](const char* key, double& mm) {
    const auto found = settings.find(key);
    if (found == settings.end()) return;
    mm = std::strtod(found->second.c_str(), nullptr);
    settings.erase(found);
  };
  take("near", span.near_mm);
  take("far", span.far_mm);
  return span;
}

// The codes and ranges in `text`, as CodeSet::text() writes them, that `bits` can hold.
std::string heldCodes(std::string_view text, int bits) {
  const std::uint32_t top = (1u << bits) - 1;
  std::string held;
  while (!text.empty()) {
    const auto end = std::min(text.find('+'), text.size());
    if (const auto range = CodeSet::parseRange(text.substr(0, end)); range && range->low <= top) {
      held += (held.empty() ? "" : "+") + CodeSet(CodeSet::Range{range->low, std::min(range->high, top)}).text();
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return held.empty() ? "none" : held;
}

// The kinds' holes are 16-bit codes; pictures of fewer bits can hold only some of them.
void fitHoles(CalibrationSettings& settings, int bits) {
  if (const auto holes = settings.find("invalid"); holes != settings.end()) {
    holes->second = heldCodes(holes->second, bits);
  }
}

// Adds the kind's own settings, and those read beside the recording, each to the layer of its origin.
HueSpan addKind(const DepthClues& clues, const KnownKind* kind, CalibrationLayers& layers) {
  if (kind == nullptr) return {};
  if (clues.as != nullptr) layers.stated_kind = settingsOf(*clues.as);
  if (clues.place.kind != kind) return {};
  CalibrationSettings found = clues.place.settings;
  const HueSpan span = is("record3d", kind) ? takeSpan(found) : HueSpan{};
  const bool named = clues.place.origin == CalibrationOrigin::Name;
  CalibrationSettings& layer = named                                                    ? layers.names
                               : clues.place.origin == CalibrationOrigin::ContainerTags ? layers.tags
                                                                                        : layers.beside;
  layer.merge(found);
  if (clues.as == nullptr) layer.merge(settingsOf(*kind));
  return span;
}

// Gray, or bytes of a code, without lossy coding, whose name says disparity.
bool isNamedDisparity(const DepthClues& clues, const Frame& look) {
  return clues.code == DepthCode::Luma && look.model != ColorModel::Yuv && !definesCodes(saidLayers(clues)) &&
         saysDisparity(clues.path);
}

// The name says that near is bright and codes are 1/distance; only the range of codes is read from the picture.
DepthReading readNamedDisparity(const Frame& look, const CodeCount& count, CalibrationLayers& layers) {
  DepthReading read = readFloats(look, count, true, layers);
  for (const char* key : {"law", "polarity"}) {
    if (auto part = read.settings.extract(key); !part.empty()) layers.names.insert(std::move(part));
  }
  if (!read.why.empty()) read.why = "the name says disparity: " + read.why;
  if (!read.offer.empty())
    read.offer = "if it is brightness from far to near: --as near-bright; if from near to far: --as near-dark";
  return read;
}

CodeCount countOf(const Frame& look, std::span<const Frame> later) {
  CodeCount count(look);
  for (const Frame& picture : later) count.addLater(picture);
  return count;
}

// Arrays of numbers without a hole are a network's, of which many give relative disparities and call them depth.
bool isOfNetwork(const DepthClues& clues, const CodeCount& count) {
  constexpr double kMostHoles = 0.002;
  return clues.codec == "npy" && count.share(0, 0) < kMostHoles;
}

// Video Depth Anything writes relative disparities unless it is told to write metres.
bool isOfVideoDepthAnything(const DepthClues& clues, const Frame& look, const CodeCount& count) {
  return clues.path.find("_depths.npz") != std::string::npos && isOfNetwork(clues, count) &&
         !looksLikeDistance(look, count);
}

// A relative disparity has an arbitrary zero, whatever its range.
void makeRelative(DepthReading& read) {
  read.settings["law"] = "linear";
  read.settings.erase("near");
  read.settings.erase("far");
}

// Numbers are what their name says, else what is usual in their files: in PFM disparities, unless the view shows that
// they are none. Numbers that begin at 0, or are a network's, are relative disparities if that makes the view nearer
// below, and doubted as distances. A sensor's 65535 is none of them.
DepthReading readNumbers(const DepthClues& clues, const Frame& look, const CodeCount& all,
                         const CalibrationLayers& layers) {
  const auto full = fullCode(look, all);
  const CodeCount& count = full ? all.without(CodeSet(*full)) : all;
  const auto named = namesDisparity(clues.path);
  const bool doubtful_pfm = clues.codec == "pfm" && !named && !mayBeMetres(look, count);
  const bool usual = named.value_or(doubtful_pfm && !looksLikeDistance(look, count));
  const bool open = !usual && !definesCodes(layers);
  const bool network = open && !full && isOfNetwork(clues, count);
  const bool seen = (network && isOfVideoDepthAnything(clues, look, count)) ||
                    (!usual && (areRelative(count) || network) && looksLikeDisparity(look, count));
  DepthReading read = readFloats(look, all, usual || seen, layers);
  if (seen && network) makeRelative(read);
  read.unsure = read.unsure || seen || (doubtful_pfm && !looksLikeDisparity(look, count)) || (network && !named) ||
                (!usual && areRelative(count) && !areFromAfar(look, count));
  return read;
}

// Samples of brightness, of distances or of disparities, as the clues require; may add what they show to `layers`.
DepthReading readSamples(const DepthClues& clues, const KnownKind* kind, const Frame& look, const CodeCount& count,
                         CalibrationLayers& layers) {
  if (is("middlebury", kind) && clues.place.camera) return readDisparities(look, count, *clues.place.camera);
  if ((is("middlebury", kind) || is("sintel-disparity", kind)) && look.value_per_code == 0) {
    return readFloats(look, count, true, layers);
  }
  if (look.value_per_code != 0 && !is("heights", kind)) {
    scaleToCodes(layers, look);
    return readNumbers(clues, look, count, layers);
  }
  if (kind == nullptr && isNamedDisparity(clues, look)) return readNamedDisparity(look, count, layers);
  return readCodes(look, count, layers, kind);
}

// A background far behind all else is no part of a shape in distances.
DepthReading readInFront(const DepthClues& clues, const KnownKind* kind, const Frame& look, const CodeCount& count,
                         CalibrationLayers& layers) {
  const bool open = !layers.command_line.contains("invalid") && !layers.side_file.contains("invalid") &&
                    !says(layers, {"near", "far"}) && (kind == nullptr || kind->inverse.mm == 0);
  const auto full = fullCode(look, count);
  const auto background = open ? farBackground(full ? count.without(CodeSet(*full)) : count) : std::nullopt;
  if (!background) return readSamples(clues, kind, look, count, layers);
  CalibrationLayers in_front = layers;
  DepthReading read = readSamples(clues, kind, look, count.without(CodeSet(*background)), in_front);
  in_front.pictures = read.settings;
  const std::string* const unit = in_front.find("unit");
  if (unit == nullptr || *unit == "none") return readSamples(clues, kind, look, count, layers);
  in_front.pictures.clear();
  layers = std::move(in_front);
  leaveOut(*background, count, layers, read);
  return read;
}

// Reads the pictures as the clues require; may add what they show to `layers`.
DepthReading readPictures(const DepthClues& clues, const KnownKind* kind, const Frame& look,
                          std::span<const Frame> later, const HueSpan& span, CalibrationLayers& layers) {
  DepthReading read;
  if (clues.code == DepthCode::Hue) {
    read = readHues(look, layers, kind, span, later);
    const bool like_record3d = kind == nullptr && clues.packing == Packing::SideBySideDepthFirst;
    if (like_record3d && (!read.settings.empty() || hasRed(look))) {
      read = readHues(look, layers, findKind("record3d"), span, later);
      read.kind = findKind("record3d");
    }
  } else if (clues.code != DepthCode::Luma) {
    read = readColorMap(look, clues.code, layers);
  } else {
    read = readInFront(clues, kind, look, countOf(look, later), layers);
  }
  if (clues.live && read.kind == nullptr) {
    read.doubt.clear();
    read.settings.erase("near");
    read.settings.erase("far");
  }
  if (!later.empty() && !read.why.empty()) read.why += print(", judged by %zu pictures", later.size() + 1);
  return read;
}

}  // namespace

const KnownKind* kindOf(const DepthClues& clues, const Frame& stored, std::span<const Frame> later) {
  if (clues.as != nullptr) return clues.as;
  if (hasEqualColors(stored)) {
    const auto gray = inOrder(stored, SampleOrder::EqualColors);
    return gray ? kindOf(clues, *gray, later) : nullptr;
  }
  if (is("middlebury", clues.place.kind) && clues.code == DepthCode::Luma && !definesCodes(saidLayers(clues))) {
    return clues.place.kind;
  }
  if (definesCodes(saidLayers(clues))) return nullptr;
  if (stored.value_per_code != 0) return is("unreal", clues.place.kind) ? clues.place.kind : nullptr;
  if (clues.place.kind != nullptr && fits(*clues.place.kind, clues.code, stored)) {
    const CodeCount count = countOf(stored, later);
    return isOfMmAsTum(clues, stored, count) ? sensorKind(stored, count) : clues.place.kind;
  }
  if (isNamedDisparity(clues, stored)) {
    return packedOrder(stored) == SampleOrder::RedGreen ? findKind("sintel-disparity") : nullptr;
  }
  return clues.code == DepthCode::Luma ? sensorKind(stored, countOf(stored, later)) : nullptr;
}

bool isReachSeen(const CalibrationChoice& choice) {
  return std::any_of(choice.parts.begin(), choice.parts.end(), [](const CalibrationPart& part) {
    const bool of_reach = part.key == "near" || part.key == "far" || part.key == "codes";
    return of_reach && part.origin == CalibrationOrigin::FirstPicture;
  });
}

Result<DepthMeaning> readMeaning(const DepthClues& clues, const KnownKind* kind, const Frame& look,
                                 std::span<const Frame> later) {
  CalibrationLayers layers = saidLayers(clues);
  if (look.value_at_zero != 0 && says(layers, {"unit"})) return std::unexpected(kNoDistances);
  const HueSpan span = addKind(clues, kind, layers);
  fitHoles(layers.stated_kind, look.components[0].bits);
  const bool film = clues.code == DepthCode::Luma && look.model == ColorModel::Yuv;
  const bool open = kind == nullptr && !definesCodes(layers);
  if (film && open && saysDisparity(clues.path)) layers.names.insert({"polarity", "near-high"});
  DepthReading read = readPictures(clues, kind, look, later, span, layers);
  layers.pictures = clues.pictures;
  layers.pictures.merge(read.settings);
  auto choice = chooseNearEnd(clues, look, layers, read);
  if (!choice) return std::unexpected(choice.error());
  NearEndDoubt doubt = doubtNearEnd(*choice, kind != nullptr || read.kind != nullptr, look, read);

  DepthMeaning meaning{.calibration = std::move(*choice), .reading = {}};
  FilmReading& reading = meaning.reading;
  reading.parts.push_back({"packing", name(clues.packing), clues.packing_by});
  reading.parts.push_back({"code", name(clues.code), clues.code_by});
  const bool placed = kind != nullptr && clues.place.kind == kind;
  if (kind == nullptr) kind = read.kind;
  if (kind != nullptr) {
    const auto by = clues.as != nullptr ? CalibrationOrigin::StatedKind
                    : placed            ? clues.place.origin
                                        : CalibrationOrigin::FirstPicture;
    reading.parts.push_back({"kind", kind->what, by});
  }
  reading.parts.insert(reading.parts.end(), clues.more.begin(), clues.more.end());
  reading.parts.insert(reading.parts.end(), meaning.calibration.parts.begin(), meaning.calibration.parts.end());
  reading.why = clues.why;
  if (placed) reading.why.push_back(clues.place.why);
  if (!read.why.empty()) reading.why.push_back(std::move(read.why));
  if (!read.offer.empty()) reading.offers.push_back(std::move(read.offer));
  if (is("mm", kind) && is("tum", clues.place.kind) && clues.as == nullptr) reading.doubts.emplace_back(kAsTum);
  if (!doubt.line.empty()) reading.doubts.push_back(std::move(doubt.line));
  if (!read.doubt.empty()) reading.doubts.push_back(std::move(read.doubt));
  reading.near_end_is_usual = doubt.usual;
  return meaning;
}

}  // namespace relievo
