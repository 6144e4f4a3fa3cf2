// SPDX-License-Identifier: Apache-2.0
// Decides which tracks of a film's source are its colour, its depth and its material, and says why.
#pragma once

#include <string>
#include <vector>

#include "app/media/pairs/film_scout.h"
#include "app/media/pairs/open_film.h"
#include "app/media/reading/recording_place.h"

namespace relievo {

struct FilmPlan {
  TrackPlan tracks;  // of the colour's source, which is open
  CalibrationOrigin packing_by = CalibrationOrigin::StreamSignalling;
  std::vector<std::string> why;  // one line each
};
// `place`: what the recording's folder and files show. Errors as planTracks.
[[nodiscard]] Result<FilmPlan> planFilm(const OpenFilm& film, const FilmScout& scout, const RecordingPlace& place);

}  // namespace relievo
