// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/depth_reading.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/media/reading/codes/far_background.h"
#include "app/media/reading/codes/measured_codes.h"
#include "app/media/reading/codes/stragglers.h"
#include "app/media/reading/float_reading.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;

constexpr double kNotRaw = 0.002;

// For users who know the unit of a recording.
constexpr const char* kAnyUnit = "in any other unit: --calibration unit=MM,invalid=0";

// Of 11 bits the highest is a hole; some recorders write the code beyond.
constexpr std::uint32_t kRawHole = 2047, kRawHoleBeyond = 2048, kRawLowest = 300, kRawHighest = 1084;

// Most scenes lie beyond .6 m: 3000 codes at 5000 a metre. No sensor sees nearer than .2 m, which is 1000 of those.
constexpr std::uint32_t kNearestOfFine = 3000, kLeastOfFine = 1000;

// mm in tenths: steps of ten codes that 8, 10 or 12 bits stretched to 16 do not make.
constexpr std::uint32_t kTenths = 10, kMostStep = 8;

// Near and far are taken from all samples except outliers, with a margin because later pictures may show more.
constexpr double kOutliers = 0.002, kNearer = 0.9, kFarther = 1.1;

std::string number(double value) {
  return print("%.6g", value);
}

std::string holesText(double share) {
  return share == 0 ? "" : print(" with %.1f %% holes", 100 * share);
}

// Codes that are distances: near and far follow from the lowest and the highest code in use.
DepthReading readDistances(const CodeCount& count, double unit_mm, const CodeSet& invalid, const char* what) {
  const CodeCount valid = count.without(invalid);
  if (valid.samples() == 0) return {};
  const DistanceReach reach = distanceReach(valid, 0, kTop);
  const double near = std::max(1.0, std::floor(kNearer * unit_mm * reach.low));
  const auto farOf = [&](double high) { return std::max(near + 1, std::ceil(kFarther * unit_mm * high)); };
  DepthReading reading;
  reading.settings = {{"near", number(near)}, {"far", number(farOf(reach.high))}};
  reading.doubt = stragglersLine(reach, unit_mm, near, farOf(reach.farthest));
  reading.why =
      print("codes of %u to %u%s: %s, %.2f to %.2f m", reach.low, reach.high, holesText(count.share(invalid)).c_str(),
            what, 1e-3 * unit_mm * reach.low, 1e-3 * unit_mm * reach.high);
  return reading;
}

// Codes that are inversely proportional to the distance: the range in use, and its distances.
DepthReading readInverse(const CodeCount& count, const KnownKind& kind, const CodeSet& invalid) {
  const CodeCount valid = count.without(invalid);
  if (valid.samples() == 0) return {};
  const bool raw = kind.inverse.offset > 0;
  const auto lowest = raw ? kRawLowest : 1;
  const auto reach = valid.reach(kOutliers, lowest, raw ? kRawHighest : kTop);
  const std::uint32_t low = reach.low, high = std::max(reach.high, reach.low + 1);
  const auto mm = [&](double code) { return kind.inverse.mm / (raw ? kind.inverse.offset - code : code); };
  const double near = mm(raw ? low : high), far = mm(raw ? high : low);
  DepthReading reading;
  reading.settings = {{"codes", print("%u-%u", low, high)}, {"near", number(near)}, {"far", number(far)}};
  reading.why = print("codes of %u to %u%s: %s, %.2f to %.2f m", low, high, holesText(count.share(invalid)).c_str(),
                      kind.what, 1e-3 * near, 1e-3 * far);
  return reading;
}

bool isRawKinect(const CodeCount& count) {
  const double outside = count.share(1, kRawLowest - 1) + count.share(kRawHighest + 1, kRawHole - 1);
  return count.share(kRawHoleBeyond + 1, kTop) == 0 && count.of(kRawHole) + count.of(kRawHoleBeyond) > 0 &&
         outside < kNotRaw && count.share(kRawLowest, kRawHighest) > 0.05;
}

// A Kinect's codes of a view without a hole are also what near distances in mm may be.
std::string otherCodes(const KnownKind& kind, const CodeCount& count) {
  const CodeCount all = count.together();
  const bool like_raw = all.share(kRawLowest, kRawHighest) == 1;
  return kind.name == std::string_view("mm") && like_raw ? "if they are a first Kinect's raw codes: --as kinect-raw"
                                                         : "";
}

// Numbers of a network in 16 bits (Depth Anything's raw PNG) use few of them and begin at nearly 0: no sensor sees as
// near as they would be in mm. In a resized picture of a sensor, some samples beside the holes are nearly 0 too.
bool isNetwork(const Frame& depth, const CodeCount& count) {
  constexpr std::uint32_t kNearestMm = 100, kNearMiddleMm = 200;
  constexpr double kBesideHoles = 0.02;
  if (count.share(1, kTop) == 0) return false;
  const auto reach = count.reach(kOutliers, 1, kTop);
  if (depth.model != ColorModel::Gray || count.bits() != 16 || count.step() > kMostStep) return false;
  if (reach.high >= kMaybeStretched) return false;
  const bool has_zero = count.share(0, 0) > kOutliers;
  if (areRelative(count) && count.quantile(has_zero ? kBesideHoles : kOutliers, 1, kTop) < kNearestMm) return true;
  // Few codes: those of a close view, or of centimetres, leave a gap above the holes.
  const bool has_holes = has_zero && reach.low > 1;
  return !has_holes && count.quantile(0.5, 1, kTop) < kNearMiddleMm && looksLikeDisparity(depth, count);
}

DepthReading readNetwork(const CodeCount& count) {
  const auto reach = count.reach(kOutliers, 0, kTop);
  const double high = std::ceil(kFarther * std::max(reach.high, reach.low + 1));
  DepthReading reading;
  reading.settings = {{"codes", print("%u-%.0f", reach.low, high)}};
  reading.near_high = true;
  reading.why = print("codes of %u to %u: a network's numbers, too near for distances in mm", reach.low, reach.high);
  reading.offer = "if they are distances in mm: --as mm";
  return reading;
}

// For heights: the range of codes.
DepthReading readHeights(const CodeCount& count, const CodeSet& holes) {
  const CodeCount valid = count.without(holes);
  if (valid.samples() == 0) return {};
  const auto reach = valid.reach(kOutliers, 0, kTop);
  const double margin = (kFarther - 1) * std::max(1.0, static_cast<double>(reach.high) - reach.low);
  const double low = std::max(0.0, std::floor(reach.low - margin)), high = std::min<double>(kTop, reach.high + margin);
  DepthReading reading;
  reading.settings = {{"codes", print("%.0f-%.0f", low, std::ceil(high))}};
  reading.why = print("codes of %u to %u: heights", reach.low, reach.high);
  return reading;
}

// If no sample is a hole, distances cannot be distinguished from heights.
std::string otherEnd(const CodeCount& count) {
  return count.share(0, 0) + count.share(kTop, kTop) > 0 ? "" : "if high codes are near (heights): --as heights";
}

std::string both(const std::string& first, const std::string& second) {
  return first + (first.empty() || second.empty() ? "" : "; ") + second;
}

// Disparities have holes as distances have, and are as high as those of 5000 codes a metre or as scattered as a
// laser's.
std::string otherLaw(const KnownKind& kind, const CodeCount& count) {
  const bool high =
      count.quantile(0.5, 1, kTop - 1) > kMiddleMm || count.quantile(1 - kOutliers, 1, kTop - 1) > kFarthestMm;
  if (!high && kind.name != std::string_view("kitti")) return "";
  return "if they are disparities, 256 codes a pixel: --as kitti-disparity";
}

constexpr const char* kTenthsOfMm = "if 10000, as RealSense's D405 has: --as ycb";

// Other units that the distances may have. The relief is the same; its depth in mm is not.
std::string otherUnit(const KnownKind& kind, const CodeCount& count) {
  const bool fine = count.quantile(0.5, 1, kTop - 1) > kNearestOfFine;
  // Sensors leave holes, networks do not.
  const char* const zoedepth = count.share(0, 0) == 0 ? "if there are 256 codes a metre: --as zoedepth" : "";
  if (kind.name == std::string_view("tum")) return both(both("if a code is 1 mm: --as mm", kTenthsOfMm), zoedepth);
  if (kind.name == std::string_view("ycb")) return both("if a code is 1 mm: --as mm", zoedepth);
  if (kind.name == std::string_view("mm") && fine)
    return both(both("if there are 5000 codes a metre: --as tum", kTenthsOfMm), zoedepth);
  constexpr std::uint32_t kNearMm = 1500;  // few sensors in mm see nothing beyond
  if (kind.name == std::string_view("mm") && count.quantile(1 - kOutliers, 1, kTop - 1) < kNearMm)
    return *zoedepth != '\0' ? zoedepth : "if there are 256 codes a metre: --as kitti";
  if (kind.name == std::string_view("mm")) return zoedepth;
  return kind.name == std::string_view("kitti") ? "if a code is 1 mm: --as mm" : "";
}

// No sensor sees a whole view as near as that.
bool isTooNear(const CodeCount& count, const KnownKind& kind) {
  constexpr std::uint32_t kNearestMm = 50;
  return kind.name == std::string_view("mm") && count.quantile(1 - kOutliers, 1, kTop - 1) < kNearestMm;
}

// What else codes may be whose kind only the pictures show.
std::string otherKinds(const KnownKind& kind, const CodeCount& count) {
  if (kind.inverse.mm > 0 || isTerrain(kind.order)) return "";
  const std::string others = both(both(otherUnit(kind, count), otherLaw(kind, count)), otherCodes(kind, count));
  return both(others, both(otherEnd(count), kAnyUnit));
}

// Other recorders, too, make folders that look like TUM's.
std::string offerMillimetres(const Frame& depth, const CodeCount& count, const CalibrationLayers& said) {
  const std::string* const unit = said.find("unit");
  if (unit == nullptr || *unit != "0.2" || said.command_line.contains("unit")) return "";
  const KnownKind* const kind = sensorKind(depth, count);
  return kind != nullptr && kind->name == std::string_view("mm") ? "if a code is 1 mm: --as mm" : "";
}

// For codes whose meaning is known: reads near, far and the range of codes.
DepthReading readReach(const CodeCount& count, const CalibrationLayers& said, const KnownKind* kind) {
  const std::string* const unit = said.find("unit");
  const std::string* const invalid = said.find("invalid");
  const CodeSet holes = invalid != nullptr ? CodeSet::parse(*invalid).value_or(CodeSet()) : CodeSet();
  const bool heights = kind != nullptr && (kind->name == std::string_view("heights") || isTerrain(kind->order));
  if (heights && !says(said, {"codes"})) {
    return readHeights(count, holes);
  }
  if (kind != nullptr && kind->inverse.mm > 0 && !says(said, {"codes", "near", "far"})) {
    return readInverse(count, *kind, holes);
  }
  if (unit == nullptr || *unit == "none" || says(said, {"near", "far"})) return {};
  const double unit_mm = std::strtod(unit->c_str(), nullptr);
  return readDistances(count, unit_mm, holes,
                       kind != nullptr ? kind->what : print("distances of %g mm a code", unit_mm).c_str());
}

}  // namespace

bool definesCodes(const CalibrationLayers& said) {
  return says(said, {"law", "polarity", "range", "codes", "unit"});
}

const KnownKind* sensorKind(const Frame& depth, const CodeCount& all) {
  if (hasEqualColors(depth)) {
    const auto gray = inOrder(depth, SampleOrder::EqualColors);
    return gray ? sensorKind(*gray, all) : nullptr;
  }
  if (const SampleOrder packed = packedOrder(depth); packed != SampleOrder::AsStored) {
    const auto ordered = inOrder(depth, packed);
    if (isTerrain(packed)) return findKind(packed == SampleOrder::Terrarium ? "terrarium" : "mapbox");
    const bool distances = ordered && isDistances(CodeCount(*ordered));
    if (packed == SampleOrder::FloatBytes) return findKind("tartanair");
    if (packed == SampleOrder::BlueGreen) return findKind(isConstant(depth, 0) ? "bg-packed" : "carla");
    if (packed == SampleOrder::Below20) return findKind("carla-near");
    if (!distances) return nullptr;
    if (packed == SampleOrder::GreenBlue) return findKind("gb-packed");
    return findKind(packed == SampleOrder::RedGreen ? "rg-packed" : "gr-packed");
  }
  if (depth.model != ColorModel::Gray || all.bits() != 16) return nullptr;
  if (isSwapped(depth)) {
    const auto ordered = inOrder(depth, SampleOrder::Swapped);
    if (!ordered) return nullptr;
    const CodeCount of_ordered(*ordered);
    if (isRawKinect(of_ordered)) return findKind("nyu-raw");
    if (isMeasured(of_ordered) && isDistances(of_ordered)) return findKind("mm-swapped");
  }
  if (isRawKinect(all.together())) return findKind("kinect-raw");
  if (isMeasured(all) && hasConfidence(depth)) return findKind("depth16");
  if (isMeasured(all) && hasPlayers(all)) return findKind("kinect-players");
  if (isMeasured(all) && isRotated(all)) return findKind("sun");
  const auto background = farBackground(all);
  const CodeCount& count = background ? all.without(CodeSet(*background)) : all;
  const std::uint32_t step = count.step();
  if ((step > kMostStep && step != kTenths) || !isDistances(count)) return nullptr;  // fewer bits, stretched
  if (count.share(0, 0) > 0.5 && isScattered(depth)) return findKind("kitti");
  if (isNetwork(depth, count)) return nullptr;
  if (const KnownKind* const measured = kindBySteps(count, depth.width); measured != nullptr) return measured;
  const auto reach = count.reach(kOutliers, 1, kTop - 1);
  const CodeCount together = count.together();
  const bool far = reach.high > kFarthestMm || together.quantile(0.5, 1, kTop - 1) > kMiddleMm;
  const bool fine = far && reach.low > kLeastOfFine && !beginsNearerThanKinectSees(together);
  return findKind(!fine ? "mm" : step == kTenths ? "ycb" : "tum");
}

DepthReading readCodes(const Frame& depth, const CodeCount& count, const CalibrationLayers& said,
                       const KnownKind* kind) {
  if (definesCodes(said)) {
    if (says(said, {"unit"}) || kind != nullptr) {
      DepthReading reading = readReach(count, said, kind);
      reading.offer = both(reading.offer, offerMillimetres(depth, count, said));
      if (!reading.settings.empty() || depth.model != ColorModel::Yuv) return reading;
    }
    // Only the near end was stated, and not by the film's maker, who would have stated the holes too.
    const bool shades =
        said.command_line.contains("polarity") && said.tags.empty() && !says(said, {"unit", "law", "codes"});
    return depth.model == ColorModel::Yuv || shades ? readShades(depth, count, said) : DepthReading{};
  }
  if (kind == nullptr || !definesCodes({.pictures = settingsOf(*kind)})) kind = sensorKind(depth, count);
  if (kind == nullptr) return isNetwork(depth, count) ? readNetwork(count) : readShades(depth, count, said);
  CalibrationLayers with = said;
  with.pictures = settingsOf(*kind);
  DepthReading reading = readReach(count, with, kind);
  reading.kind = kind;
  reading.offer = otherKinds(*kind, count);
  const bool network = !otherEnd(count).empty() && looksLikeDisparity(depth, count);
  const bool too_near = isTooNear(count, *kind);
  if (too_near) reading.offer = "read so, all is nearer than a sensor sees: " + reading.offer;
  reading.unsure = !reading.offer.empty() && (network || too_near);
  reading.settings.merge(with.pictures);
  return reading;
}

}  // namespace relievo
