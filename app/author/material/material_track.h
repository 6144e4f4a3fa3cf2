// SPDX-License-Identifier: Apache-2.0
// The pictures of a film's material track: from painted maps that follow the film, or from a film of maps.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/author/material/map_follower.h"
#include "app/author/material/painted_map.h"
#include "app/author/material/painting.h"
#include "app/author/package/picture.h"
#include "app/media/pair_reader.h"
#include "app/media/tracks/track_reader.h"
#include "app/scene/material.h"
#include "platform/failure.h"

namespace relievo {

// A painting stays on the objects that it covers until the shot ends, they leave the picture, or the next painting
// begins. A film of maps is used as it is, by its times; its last picture holds.
class MaterialTrack {
 public:
  // Values of full codes that the user's words do not state.
  static constexpr Material kFull{
      .stiffness_n_per_mm = 1, .friction = Friction{0.6, 0.5}, .texture = Texture{0.2, 0.8}};
  // Wider ones are scaled down: a map is as fine as a finger feels.
  static constexpr int kMostCols = 320;

  // `paintings`: one or more, by their times, or a film of maps. `words`: what full codes stand for. The track has the
  // shape of a film of `width` x `height`.
  [[nodiscard]] static Outcome<MaterialTrack> open(const std::vector<Painting>& paintings, const Material& words,
                                                   const PairReader::Backends& backends, int width, int height);

  [[nodiscard]] int cols() const noexcept { return cols_; }
  [[nodiscard]] int rows() const noexcept { return rows_; }
  // The material at the highest code, in the parts that the maps hold; a gray map holds stiffness alone.
  [[nodiscard]] const Material& scale() const noexcept { return scale_; }

  // The next picture of the film; `begins_shot`: nothing in it continues the one before. The result is valid until the
  // next call.
  [[nodiscard]] Result<const ColorPicture420*> at(const ColorPicture420& color, MediaTime time, bool begins_shot);
  // For the author: the cuts after which nothing is painted, and the paintings that begin after the film's end.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  MaterialTrack() = default;
  // Appends the painting to `coming_`. Returns the colour model of its picture.
  [[nodiscard]] Result<ColorModel> read(const Painting& painting, bool alone, const PairReader::Backends& backends);
  [[nodiscard]] Result<void> passTo(MediaTime time);
  [[nodiscard]] bool beginPainting(MediaTime time);
  void follow(const ColorPicture420& color, MediaTime time, bool begins_shot);
  void draw(const std::vector<PaintedMap::Codes>& codes);
  [[nodiscard]] std::vector<PaintedMap::Codes> asPainted() const;
  [[nodiscard]] PaintedMap::Codes unpainted() const;

  int cols_ = 0, rows_ = 0;
  Material scale_;
  PaintedMap map_;                                      // the painting that applies now
  std::deque<std::pair<Painting, PaintedMap>> coming_;  // paintings that have not begun
  std::unique_ptr<TrackReader> reader_;                 // of a film of maps
  std::optional<Frame> next_;
  MapFollower follower_;
  bool has_begun_ = false;          // the first painting has begun
  std::vector<MediaTime> ends_at_;  // cuts without a painting
  ColorPicture420 picture_;
};

}  // namespace relievo
