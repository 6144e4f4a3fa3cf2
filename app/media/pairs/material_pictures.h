// SPDX-License-Identifier: Apache-2.0
// Reads the track that gives the surface's material at each place, beside the colour.
#pragma once

#include <optional>

#include "app/media/depth_follower.h"
#include "app/media/tracks/track_reader.h"
#include "app/scene/material.h"
#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo {

// Without the track, or after it fails, the film has one material everywhere. One thread.
class MaterialPictures {
 public:
  // Selects the film's material track in the colour's source; nullopt if it has none. Call when the source is opened or
  // reopened. `source` and `shift`, which is added to the track's times, must live until the next call.
  void select(TrackReader& source, const std::optional<StreamInfo>& track, const Duration& shift);
  // The picture for this colour time; empty: none. After an error, call it again or give the track up.
  [[nodiscard]] Result<Frame> at(MediaTime time);
  // After a seek in the source.
  void restart() noexcept;
  void giveUp() noexcept { follower_.reset(); }

  // The values of the track's full codes; empty without a track.
  [[nodiscard]] const Material& scale() const noexcept { return scale_; }
  // Why the track cannot be used; null if there is none or it is used.
  [[nodiscard]] const char* refused() const noexcept { return refused_; }

 private:
  std::optional<DepthFollower> follower_;
  Material scale_;
  const char* refused_ = nullptr;
};

}  // namespace relievo
