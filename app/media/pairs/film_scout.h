// SPDX-License-Identifier: Apache-2.0
// Looks at later pictures of a film: for one that is not blank, and for the range of its depth.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/media/pairs/open_film.h"
#include "app/media/tracks/track_reader.h"

namespace relievo {

// True for a source that can be opened a second time at no cost to others.
[[nodiscard]] bool isFile(const std::string& url);

// Reads files through readers of its own, so that the film's position stays; returns early when the film is
// interrupted.
class FilmScout {
 public:
  explicit FilmScout(OpenFilm& film) : film_(film) {}

  // A second reader of the stream, as track 0; null if the source cannot be read twice, as a pipe.
  [[nodiscard]] std::unique_ptr<TrackReader> readerOf(const std::string& url, int stream) const;
  // Returns `first`, or if it is blank a later picture of the same stream. Examines fewer pictures if they are large.
  [[nodiscard]] Frame tellingPicture(const Frame& first, const std::string& url, int stream) const;
  // Up to seven depth pictures, spread over the film from its start to its end; fewer if they are large or reading them
  // takes long. `depth_in`: the depth in a picture as it is stored. `seen`: the time of the first, which is left out.
  using DepthIn = std::function<Result<Frame>(const Frame& stored)>;
  [[nodiscard]] std::vector<Frame> laterPictures(MediaTime seen, int stream, const DepthIn& depth_in) const;

 private:
  OpenFilm& film_;
};

}  // namespace relievo
