// SPDX-License-Identifier: Apache-2.0
// Looks at later pictures of a film: for one that is not blank, and for the range of its depth.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "app/media/pairs/pair_film.h"
#include "app/media/reading/picture_look.h"
#include "hal/media/samples.h"
#include "platform/files/answered_place.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

// The share and range of later pictures' depth beyond the range first read.
struct Beyond {
  int samples = 0, valid = 0, outside = 0;
  double low = 0, high = 0;  // the codes in use, without outliers
};

Beyond beyondIn(const Frame& depth, const DepthCalibration& calibration) {
  constexpr int kAcross = 96, kDown = 64;
  constexpr double kOutliers = 0.002;
  const int across = std::min(kAcross, depth.width), down = std::min(kDown, depth.height);
  const double low = calibration.lowCode(), high = calibration.highCode();
  std::vector<std::uint32_t> codes;
  codes.reserve(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  Beyond beyond;
  for (int j = 0; j < down; ++j) {
    const int r = (2 * j + 1) * depth.height / (2 * down);
    for (int i = 0; i < across; ++i) {
      const int c = (2 * i + 1) * depth.width / (2 * across);
      const auto code = codeAt(depth, brightnessOf(depth), c, r);
      if (calibration.invalid.contains(code)) continue;
      codes.push_back(code);
      if (code < low || code > high) ++beyond.outside;
    }
  }
  beyond.samples = across * down;
  beyond.valid = static_cast<int>(codes.size());
  if (codes.empty()) return beyond;
  std::ranges::sort(codes);
  const auto outliers = static_cast<std::size_t>(kOutliers * static_cast<double>(codes.size()));
  beyond.low = codes[outliers];
  beyond.high = codes[codes.size() - 1 - outliers];
  return beyond;
}

// The distance of a code beyond those of the calibration: the inverse law is linear in 1/distance.
double distanceOf(const DepthCalibration& c, double code) {
  const bool near_high = c.polarity == DepthPolarity::NearIsHigh;
  const double at_low = near_high ? c.far_mm : c.near_mm, at_high = near_high ? c.near_mm : c.far_mm;
  const double s = (code - c.lowCode()) / (c.highCode() - c.lowCode());
  if (c.law == DepthLaw::Inverse) return 1 / ((1 - s) / at_low + s / at_high);
  return at_low + s * (at_high - at_low);
}

// The option to type so that the codes of `beyond` are included. `value`: of a code, 1 unless codes stand for floats,
// whose own numbers the option takes.
std::string widerOption(const DepthCalibration& c, const Beyond& beyond, double value) {
  constexpr double kNearer = 0.9, kFarther = 1.1;
  const double low = std::min(beyond.low, c.lowCode()), high = std::max(beyond.high, c.highCode());
  if (c.unit_mm) {
    const double near = beyond.low < c.lowCode() ? kNearer * *c.unit_mm * low : c.near_mm;
    const double far = beyond.high > c.highCode() ? kFarther * *c.unit_mm * high : c.far_mm;
    return print("near=%.0f,far=%.0f", std::max(1.0, std::floor(near)), std::ceil(far));
  }
  const char* const law = c.law == DepthLaw::Inverse ? "inverse" : "linear";
  const char* const polarity = c.polarity == DepthPolarity::NearIsHigh ? "near-high" : "near-low";
  const double one = distanceOf(c, low), other = distanceOf(c, high);
  std::string option =
      print("law=%s,polarity=%s,codes=%.0f-%.0f", law, polarity, std::floor(value * low), std::ceil(value * high));
  if (!c.invalid.empty()) option += ",invalid=" + c.invalid.text();
  if (std::min(one, other) > 0) option += print(",near=%.6g,far=%.6g", std::min(one, other), std::max(one, other));
  return option;
}

// For a film with a single key frame: reads on in steps of `step` while `take` is true and time is left; the time is
// not checked after a few small pictures.
void readOn(TrackReader& scout, Duration step, MonotonicTime until, const std::function<bool(const Frame&)>& take) {
  constexpr Duration kLongest = std::chrono::milliseconds(400);
  constexpr std::int64_t kFew = 1 << 22;  // samples
  const MonotonicClock clock;
  until = std::min(until, clock.now() + kLongest);
  if (!scout.seek(MediaTime{})) return;
  std::int64_t samples = 0;
  for (MediaTime due(step); samples < kFew || clock.now() < until;) {
    const auto picture = scout.next(0);
    if (!picture || !*picture) return;
    samples += std::int64_t{(*picture)->width} * (*picture)->height;
    if ((*picture)->pts < due) continue;
    due = (*picture)->pts + step;
    if (!take(**picture)) return;
  }
}

}  // namespace

// True for a source that can be opened a second time at no cost to others.
bool PairReader::Impl::isFile(const std::string& url) {
  return url.find("://") == std::string::npos && !url.starts_with("v4l2:");
}

// A second reader of the stream, as track 0; null if the source cannot be read twice, as a pipe.
std::unique_ptr<TrackReader> PairReader::Impl::scoutOf(const std::string& url, int stream) const {
  if (remote || !isFile(url) || (isThere(url) && !isRegularFile(url) && !isFolder(url))) return nullptr;
  auto scout = std::make_unique<TrackReader>(backends.make_source(url), backends.make_decoder);
  if (!scout->open(url, options.frames_per_s)) return nullptr;
  const auto& streams = scout->source().streams();
  const auto same =
      std::find_if(streams.begin(), streams.end(), [&](const StreamInfo& s) { return s.index == stream; });
  if (same == streams.end() || !scout->select(asTold(*same))) return nullptr;
  return scout;
}

// Returns `first`, or if it is blank a later picture of the same stream. Examines fewer pictures if they are large.
Frame PairReader::Impl::tellingPicture(const Frame& first, const std::string& url, int stream) {
  constexpr std::int64_t kMostPictures = 40, kMostSamples = 1 << 27;
  constexpr std::array kLater{2, 5, 10, 20, 40};  // seconds
  if (!isBlank(first) || sources.interrupted()) return first;
  const auto scout = scoutOf(url, stream);
  if (!scout) return first;
  const std::int64_t samples = std::max(std::int64_t{first.width} * first.height, std::int64_t{1});
  for (std::int64_t i = 0; i < std::min(kMostPictures, kMostSamples / samples); ++i) {
    if (sources.interrupted()) return first;
    const auto picture = scout->next(0);
    if (!picture || !*picture) break;
    if (!isBlank(**picture)) return **picture;
  }
  for (const int seconds : kLater) {
    if (sources.interrupted() || !scout->seek(mediaTime(seconds))) break;
    const auto picture = scout->next(0);
    if (!picture || !*picture) break;
    if (!isBlank(**picture)) return **picture;
  }
  return first;
}

// Up to seven depth pictures, spread over the film from its start to its end; fewer if they are large or reading them
// takes long.
std::vector<Frame> PairReader::Impl::laterPictures(MediaTime seen, int stream) {
  constexpr std::array kPlaces{1 - 1e-3, 4.0 / 7, 2.0 / 7, 6.0 / 7, 1.0 / 7, 5.0 / 7, 3.0 / 7};  // of the duration
  constexpr double kMostSamples = 1 << 24;
  constexpr Duration kLongest = std::chrono::seconds(1);
  std::vector<Frame> pictures;
  const auto scout = scoutOf(depthUrl(), stream);
  const Duration duration = scout ? scout->source().duration() : Duration(0);
  if (duration == Duration(0)) return pictures;
  const MonotonicClock clock;
  const MonotonicTime until = clock.now() + kLongest;
  // The scale of floating-point numbers is that of the first decoded picture that has one.
  auto first = scout->next(0);
  while (first && *first && (**first).value_per_code != 0 && isBlank(**first) && clock.now() < until)
    first = scout->next(0);
  if (!first || !*first) return pictures;
  const double samples = static_cast<double>((**first).width) * (**first).height;
  std::vector<MediaTime> met{seen};
  const auto keep = [&](const Frame& picture) {
    auto later = depthIn(picture);
    if (later && !isBlank(*later)) pictures.push_back(std::move(*later));
  };
  for (const double place : kPlaces) {
    const bool enough = !pictures.empty() && static_cast<double>(pictures.size() + 1) * samples > kMostSamples;
    if (enough || clock.now() > until || sources.interrupted()) break;
    if (!scout->seek(MediaTime(fromSeconds(place * toSeconds(duration))))) break;
    const auto picture = scout->next(0);
    if (!picture) break;
    if (!*picture || (*picture)->value_per_code != (**first).value_per_code) continue;
    if (std::ranges::find(met, (*picture)->pts) != met.end()) {
      if (met.size() == 1) break;  // the end is reached from the first picture alone
      continue;
    }
    met.push_back((*picture)->pts);
    keep(**picture);
  }
  if (met.size() > 1) return pictures;
  readOn(*scout, duration / (kPlaces.size() + 1), until, [&](const Frame& picture) {
    if (picture.value_per_code == (**first).value_per_code) keep(picture);
    return pictures.size() < kPlaces.size() && static_cast<double>(pictures.size() + 1) * samples <= kMostSamples;
  });
  return pictures;
}

// The depth in a picture as it is stored, as `describe` looks at it.
Result<Frame> PairReader::Impl::depthIn(const Frame& stored) {
  if (isPacked() && info.packing != Packing::DepthAlone) {
    const bool in_yuv = stored.model == ColorModel::Yuv && packed.gray == GrayFrom::Luma;
    auto halves =
        in_yuv ? splitPacked(stored, info.packing, DepthCode::Hue, GrayFrom::Luma, packed.seam) : halvesOf(stored);
    if (!halves) return std::unexpected(halves.error());
    return std::move(halves->depth);
  }
  auto ordered = inOrder(stored, reordering.order);
  return ordered && registrar ? registrar->registered(*ordered) : std::move(ordered);
}

// Reports, once, a picture that lies beyond near and far if these were guessed.
void PairReader::Impl::checkReach(const Frame& picture) {
  constexpr double kTold = 0.02;
  const DepthCalibration& calibration = info.calibration.calibration;
  if (calibration.code != DepthCode::Luma) return;
  const Beyond beyond = beyondIn(picture, calibration);
  if (beyond.outside <= kTold * beyond.samples) return;
  reach_open = false;
  log(LogLevel::Warning, "media",
      "%s: at %.1f s %.0f %% of the depth is outside the range of the first pictures, and is flat: "
      "--calibration %s",
      depthUrl().c_str(), toSeconds(picture.pts.time_since_epoch()), 100.0 * beyond.outside / beyond.samples,
      widerOption(calibration, beyond, picture.value_per_code != 0 ? std::abs(picture.value_per_code) : 1).c_str());
}

}  // namespace relievo
