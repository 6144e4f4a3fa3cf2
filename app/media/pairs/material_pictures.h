// SPDX-License-Identifier: Apache-2.0
// The pictures of a track beside the colour that say what the surface feels like at each place.
#pragma once

#include <optional>

#include "app/media/depth_follower.h"
#include "app/media/tracks/track_reader.h"
#include "app/scene/material.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo {

// A film without it, or whose track fails, is felt as a whole. One thread.
class MaterialPictures {
 public:
  // The film's track, in its colour's source, which is open for the first time or again; nullopt if it has none.
  // `source` and `shift`, which is added to the track's times, stay until the next call.
  void select(TrackReader& source, const std::optional<StreamInfo>& track, const Duration& shift);
  // The picture for this colour time; empty: none. After an error it may be asked again, or given up.
  [[nodiscard]] Result<Frame> at(MediaTime time);
  // After a seek in the source.
  void restart() noexcept;
  void giveUp() noexcept { follower_.reset(); }

  // What its full codes stand for; empty without a track.
  [[nodiscard]] const Material& scale() const noexcept { return scale_; }
  // Why there is none although the film has such a track; else null.
  [[nodiscard]] const char* refused() const noexcept { return refused_; }

 private:
  std::optional<DepthFollower> follower_;
  Material scale_;
  const char* refused_ = nullptr;
};

}  // namespace relievo
