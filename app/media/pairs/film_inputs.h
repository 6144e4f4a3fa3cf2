// SPDX-License-Identifier: Apache-2.0
// Opens the sources of a film and selects its tracks.
#pragma once

#include "app/media/pairs/open_film.h"
#include "app/media/reading/packing.h"

namespace relievo {

// Writes into the OpenFilm what is open, and into FilmInfo what the sources say about themselves. When a film is opened
// again, a separate depth source has stayed open.
class FilmInputs {
 public:
  explicit FilmInputs(OpenFilm& film) : film_(film) {}

  // The colour's source. Finds the addresses too: a folder of a film and its depth pictures is opened as both.
  [[nodiscard]] Result<void> open();
  // Selects these tracks of the colour's source, and opens the depth's source if it is another. If depth that the user
  // has not asked for cannot be had, `OpenFilm::DepthBeside::refused` says why.
  [[nodiscard]] Result<void> select(const TrackPlan& plan);

 private:
  void takeFilmOverDepth();
  void takeFacts();
  void takeDepthBeside(const StreamInfo& color);
  [[nodiscard]] Result<void> selectDepth(const StreamInfo* stream, const StreamInfo& color);
  [[nodiscard]] Result<void> openDepth(const StreamInfo& color);
  void countTracks(const TrackPlan& plan);
  void listTracks();

  OpenFilm& film_;
};

}  // namespace relievo
