// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/film_plan.h"

#include <algorithm>
#include <utility>

#include "app/media/reading/picture_look.h"
#include "platform/print.h"

namespace relievo {
namespace {

// A camera's infrared is stored as its depth is, or in 8 bits. The smoothest track is the depth if the one that was
// planned is clearly rougher.
void takeSmoothest(FilmPlan& plan, const OpenFilm& film, const FilmScout& scout) {
  constexpr double kClearly = 2;
  const MediaSource& source = film.sources.color()->source();
  const StreamInfo* smoothest = plan.tracks.depth;
  const auto tracks = likelyDepthTracks(source);
  if (std::ranges::all_of(tracks, [&](auto* track) { return track == plan.tracks.depth; })) return;
  double least = 1, planned = 1;
  for (const StreamInfo* const track : tracks) {
    const auto reader = scout.readerOf(film.options.url, track->index);
    if (!reader) return;
    const auto picture = reader->next(0);
    if (!picture || !*picture || (*picture)->model != ColorModel::Gray) return;
    const double roughness = roughnessOf(**picture);
    if (track == plan.tracks.depth) planned = roughness;
    if (track == plan.tracks.depth && roughness == 1) return;  // perhaps a sensor that has not begun to measure
    if (roughness < least) least = roughness, smoothest = track;
  }
  if (smoothest == plan.tracks.depth || planned <= kClearly * least) return;
  plan.tracks.depth = smoothest;
  plan.tracks.color = findColorTrack(source, smoothest);
  plan.why.push_back(print("track %d is the smoothest of the gray ones: it is the depth", smoothest->index));
}

}  // namespace

Result<FilmPlan> planFilm(const OpenFilm& film, const FilmScout& scout, const RecordingPlace& place) {
  using enum CalibrationOrigin;
  const SourceOptions& options = film.options;
  const bool two_sources = !options.depth_url.empty();
  const bool stated = options.packing != Packing::Auto || two_sources;
  const auto tracks = planTracks(film.sources.color()->source(),
                                 film.isInOnePicture() ? film.info.packing : options.packing, two_sources);
  if (!tracks) return std::unexpected(tracks.error());
  FilmPlan plan{.tracks = *tracks,
                .packing_by = stated           ? CommandLine
                              : tracks->by_tag ? ContainerTags
                                               : StreamSignalling,
                .why = {}};
  if (film.exchanged && tracks->depth != nullptr) {
    std::swap(plan.tracks.color, plan.tracks.depth);
    plan.why.emplace_back("the first track is gray and the second is not: the second is the colour");
  }
  if (plan.tracks.depth != nullptr) takeSmoothest(plan, film, scout);
  if (stated || plan.tracks.depth != nullptr || tracks->by_tag) return plan;
  if (options.as != nullptr) {
    if (!isPacked(options.as->packing)) return plan;
    plan.tracks.packing = options.as->packing;
    plan.packing_by = StatedKind;
  } else if (place.kind != nullptr && place.origin != Name && isPacked(place.kind->packing)) {
    plan.tracks.packing = place.kind->packing;
    plan.packing_by = place.origin;
  }
  return plan;
}

}  // namespace relievo
