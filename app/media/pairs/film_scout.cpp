// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/film_scout.h"

#include <algorithm>
#include <array>

#include "app/media/reading/picture_look.h"
#include "platform/files/answered_place.h"

namespace relievo {
namespace {

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

bool isFile(const std::string& url) {
  return url.find("://") == std::string::npos && !url.starts_with("v4l2:");
}

std::unique_ptr<TrackReader> FilmScout::readerOf(const std::string& url, int stream) const {
  if (film_.remote || !isFile(url) || (isThere(url) && !isRegularFile(url) && !isFolder(url))) return nullptr;
  auto scout = std::make_unique<TrackReader>(film_.backends.make_source(url), film_.backends.make_decoder);
  if (!scout->open(url, film_.options.frames_per_s)) return nullptr;
  const auto& streams = scout->source().streams();
  const auto same =
      std::find_if(streams.begin(), streams.end(), [&](const StreamInfo& s) { return s.index == stream; });
  if (same == streams.end() || !scout->select(film_.asTold(*same))) return nullptr;
  return scout;
}

Frame FilmScout::tellingPicture(const Frame& first, const std::string& url, int stream) const {
  constexpr std::int64_t kMostPictures = 40, kMostSamples = 1 << 27;
  constexpr std::array kLater{2, 5, 10, 20, 40};  // seconds
  if (!isBlank(first) || film_.sources.interrupted()) return first;
  const auto scout = readerOf(url, stream);
  if (!scout) return first;
  const std::int64_t samples = std::max(std::int64_t{first.width} * first.height, std::int64_t{1});
  for (std::int64_t i = 0; i < std::min(kMostPictures, kMostSamples / samples); ++i) {
    if (film_.sources.interrupted()) return first;
    const auto picture = scout->next(0);
    if (!picture || !*picture) break;
    if (!isBlank(**picture)) return **picture;
  }
  for (const int seconds : kLater) {
    if (film_.sources.interrupted() || !scout->seek(mediaTime(seconds))) break;
    const auto picture = scout->next(0);
    if (!picture || !*picture) break;
    if (!isBlank(**picture)) return **picture;
  }
  return first;
}

std::vector<Frame> FilmScout::laterPictures(MediaTime seen, int stream, const DepthIn& depth_in) const {
  constexpr std::array kPlaces{1 - 1e-3, 4.0 / 7, 2.0 / 7, 6.0 / 7, 1.0 / 7, 5.0 / 7, 3.0 / 7};  // of the duration
  constexpr double kMostSamples = 1 << 24;
  constexpr Duration kLongest = std::chrono::seconds(1);
  std::vector<Frame> pictures;
  const auto scout = readerOf(film_.depthUrl(), stream);
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
    auto later = depth_in(picture);
    if (later && !isBlank(*later)) pictures.push_back(std::move(*later));
  };
  for (const double place : kPlaces) {
    const bool enough = !pictures.empty() && static_cast<double>(pictures.size() + 1) * samples > kMostSamples;
    if (enough || clock.now() > until || film_.sources.interrupted()) break;
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

}  // namespace relievo
