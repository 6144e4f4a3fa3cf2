// SPDX-License-Identifier: Apache-2.0
// The material is paired with the colour in the same way as the depth.
#include "app/media/pairs/material_pictures.h"

#include <utility>

namespace relievo {

// The track's number may change when the film is opened again.
void MaterialPictures::select(TrackReader& source, const std::optional<StreamInfo>& track, const Duration& shift) {
  follower_.reset();
  scale_ = {};
  if (!track) return;
  const auto tag = track->tags.find(kMaterialScaleTag);
  const auto scale =
      parseMaterial(tag != track->tags.end() ? tag->second : source.source().tags().at(kMaterialScaleTag));
  const auto number = scale ? source.select(*track) : std::unexpected(scale.error());
  if (!number) {
    refused_ = number.error().message;
    return;
  }
  scale_ = *scale;
  follower_.emplace([&source, &shift, number = *number]() -> Result<DepthFollower::Supplied> {
    auto frame = source.next(number);
    if (!frame) return std::unexpected(frame.error());
    if (*frame) (*frame)->pts += shift;
    return DepthFollower::Supplied{std::move(*frame), source.ended(number)};
  });
}

Result<Frame> MaterialPictures::at(MediaTime time) {
  if (!follower_) return Frame{};
  auto match = follower_->at(time);
  if (!match) return std::unexpected(match.error());
  return std::move(match->depth);
}

void MaterialPictures::restart() noexcept {
  if (follower_) follower_->restart();
}

}  // namespace relievo
