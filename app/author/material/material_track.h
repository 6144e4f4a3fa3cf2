// SPDX-License-Identifier: Apache-2.0
// The pictures of a film's material track: from a painted map that follows the film, or from a film of maps.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/author/material/map_follower.h"
#include "app/author/material/painted_map.h"
#include "app/author/package/picture.h"
#include "app/media/pair_reader.h"
#include "app/media/tracks/track_reader.h"
#include "app/scene/material.h"
#include "platform/failure.h"

namespace relievo {

// One picture is painted over the film's first one: it stays on the things that it was painted on, until the shot ends
// or they leave the picture. A film of maps is taken as it is, by its times; its last picture holds.
class MaterialTrack {
 public:
  // What full codes stand for if the words do not say it.
  static constexpr Material kFull{
      .stiffness_n_per_mm = 1, .friction = Friction{0.6, 0.5}, .texture = Texture{0.2, 0.8}};
  // Wider ones are scaled down: a map is as fine as a finger feels.
  static constexpr int kMostCols = 320;

  // `words`: what full codes stand for. The track has the shape of a film of `width` x `height`.
  [[nodiscard]] static Outcome<MaterialTrack> open(const std::string& path, const Material& words,
                                                   const PairReader::Backends& backends, int width, int height);

  [[nodiscard]] int cols() const noexcept { return cols_; }
  [[nodiscard]] int rows() const noexcept { return rows_; }
  // Of the parts that the map has: a gray one has stiffness alone.
  [[nodiscard]] const Material& scale() const noexcept { return scale_; }

  // The next picture of the film; `begins_shot`: nothing in it continues the one before. The result is valid until the
  // next call.
  [[nodiscard]] Result<const ColorPicture420*> at(const ColorPicture420& color, MediaTime time, bool begins_shot);
  // When the painted things were lost to a cut.
  [[nodiscard]] std::optional<MediaTime> endsAt() const noexcept { return ends_at_; }

 private:
  MaterialTrack() = default;
  [[nodiscard]] Result<void> passTo(MediaTime time);
  void follow(const ColorPicture420& color, MediaTime time, bool begins_shot);
  void draw(const std::vector<PaintedMap::Codes>& codes);
  [[nodiscard]] std::vector<PaintedMap::Codes> asPainted() const;
  [[nodiscard]] PaintedMap::Codes unpainted() const;

  int cols_ = 0, rows_ = 0;
  Material scale_;
  PaintedMap map_;                       // the painted one, or the film's present one
  std::unique_ptr<TrackReader> reader_;  // of a film of maps
  std::optional<Frame> next_;
  MapFollower follower_;
  std::optional<MediaTime> ends_at_;
  ColorPicture420 picture_;
};

}  // namespace relievo
