// SPDX-License-Identifier: Apache-2.0
// Reads the material track beside the colour: a film without it, or whose track fails, is felt as a whole.
#include "app/media/pairs/pair_film.h"
#include "platform/log.h"

namespace relievo {

// When the film is opened again, the track's number is a new one.
void PairReader::Impl::selectMaterial(const TrackPlan& plan) {
  material.reset();
  info.material_scale = {};
  if (plan.material == nullptr) return;
  const auto& tags = plan.material->tags;
  const auto tag = tags.find(kMaterialScaleTag);
  const auto scale =
      parseMaterial(tag != tags.end() ? tag->second : color_reader->source().tags().at(kMaterialScaleTag));
  const auto track = scale ? color_reader->select(asTold(*plan.material)) : std::unexpected(scale.error());
  if (!track) {
    material_refused = track.error().message;
    return;
  }
  info.material_scale = withoutThoseOf(options.material, *scale);
  material.emplace([this, number = *track]() -> Result<DepthFollower::Supplied> {
    auto frame = color_reader->next(number);
    if (!frame) return std::unexpected(frame.error());
    if (*frame) (*frame)->pts += color_shift;
    return DepthFollower::Supplied{std::move(*frame), color_reader->ended(number)};
  });
}

Frame PairReader::Impl::materialAt(MediaTime time) {
  if (!material) return {};
  auto match = material->at(time);
  if (match) return std::move(match->depth);
  // Whatever ends the colour as well is told when the colour is read.
  if (match.error().code != ErrorCode::Cancelled && !isLoss(match.error())) loseMaterial(match.error());
  return {};
}

void PairReader::Impl::loseMaterial(const Error& error) {
  material.reset();
  log(LogLevel::Warning, "media", "%s: no material of places from here on: %s", options.url.c_str(), error.message);
}

}  // namespace relievo
