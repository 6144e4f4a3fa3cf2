// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/near_end.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "app/media/reading/depth_doubts.h"
#include "app/media/reading/film_reading.h"
#include "hal/media/media_names.h"
#include "platform/print.h"

namespace relievo {
namespace {

// The part of a calibration that decides which end is near.
const CalibrationPart& nearEndOf(const CalibrationChoice& choice) {
  const auto part = [&choice](const char* key) -> const CalibrationPart& {
    return *std::ranges::find(choice.parts, key, &CalibrationPart::key);
  };
  const CalibrationPart &unit = part("unit"), &law = part("law"), &polarity = part("polarity");
  if (unit.value != "none") return unit;
  const bool told = polarity.origin == CalibrationOrigin::Default && certaintyOf(law.origin) == Certainty::Said;
  return told ? law : polarity;
}

bool isColorMap(DepthCode code) noexcept {
  return code != DepthCode::Luma && code != DepthCode::Hue;
}

Result<CalibrationChoice> choose(const DepthClues& clues, const Frame& look, const CalibrationLayers& layers) {
  auto choice = chooseCalibration(layers, look, clues.code);
  if (choice) markGuesses(clues.tags, *choice);
  return choice;
}

const char* otherEndOf(const DepthCalibration& calibration) noexcept {
  return calibration.polarity == DepthPolarity::NearIsHigh ? "near-low" : "near-high";
}

// Pictures that programs write one by one; of those that are dark where they are near, most are renderings and photos
// with a lens blur. A film's gray is near where it is bright unless somebody says otherwise, also if it is coded as
// pictures are.
bool isPicture(const DepthClues& clues) noexcept {
  constexpr std::array<std::string_view, 6> kPictures{"png", "mjpeg", "webp", "bmp", "tiff", "jpeg2000"};
  return clues.single && !clues.live && std::ranges::find(kPictures, clues.codec) != kPictures.end();
}

// How much nearer the view is below than above. Black that may be a hole says nothing of that.
double nearerBelow(const Frame& look, DepthCalibration calibration, const DepthReading& read) {
  if (!read.black.empty()) calibration.invalid = CodeSet::parse(read.black).value_or(CodeSet());
  return nearerBelow(look, calibration);
}

}  // namespace

bool isStill(const StreamInfo& stream) {
  constexpr int kLeastSeconds = 2;
  if (!stream.counted) return false;
  const Ratio rate = stream.average_rate;
  if (rate.known()) return rate.num <= rate.den / kLeastSeconds;
  // A film without a container has a period, as a picture of the reader of pictures has if --fps is stated.
  return stream.duration == Duration(0) && (stream.frame_period == Duration(0) || stream.tags.contains(kFileTag));
}

Result<CalibrationChoice> chooseNearEnd(const DepthClues& clues, const Frame& look, CalibrationLayers& layers,
                                        DepthReading& read) {
  auto choice = choose(clues, look, layers);
  const bool either = isColorMap(clues.code) || (clues.code == DepthCode::Luma && isPicture(clues) && !read.near_high);
  const bool open = choice && either && nearEndOf(*choice).origin == CalibrationOrigin::Default;
  if (!open || isLevel(look, choice->calibration)) return choice;
  if (nearerBelow(look, choice->calibration, read) >= -kClearlyNearer) return choice;
  layers.pictures["polarity"] = otherEndOf(choice->calibration);
  if (!read.black.empty()) layers.pictures["invalid"] = read.black;
  read.by_view = true;
  return choose(clues, look, layers);
}

NearEndDoubt doubtNearEnd(const CalibrationChoice& choice, bool is_known, const Frame& look, DepthReading& read) {
  const DepthCalibration& calibration = choice.calibration;
  const CalibrationOrigin by = nearEndOf(choice).origin;
  if (certaintyOf(by) == Certainty::Said || isLevel(look, calibration)) return {};
  const double nearer = nearerBelow(look, calibration, read);
  const bool by_view = read.by_view || (isColorMap(calibration.code) && by == CalibrationOrigin::FirstPicture);
  const bool upside_down = nearer < -kClearlyNearer;
  if (by_view || certaintyOf(by) == Certainty::Assumed) {
    return {nearEndLine(calibration, nearer, read.black), !upside_down};
  }
  if (!read.unsure && (!upside_down || is_known)) return {};
  if (read.offer.empty() && !calibration.unit_mm) {
    read.offer = print("if the other end is near: --calibration polarity=%s", otherEndOf(calibration));
  }
  if (read.offer.empty()) return {};
  const char* const view = upside_down ? "read so, the view is nearer above than below, as few are: " : "";
  return {view + std::exchange(read.offer, ""), false};
}

}  // namespace relievo
