// SPDX-License-Identifier: Apache-2.0
// A folder of films as a list; pictures that a shell has listed as one film.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/media/playlist.h"

namespace relievo {

// The films in the folder `url`, in natural order; nullopt if it is no folder or no list of films (a recording with a
// folder `depth`, a series of pictures). "a-depth.mp4" beside "a.mp4" is that film's depth. At most kMostEntries.
[[nodiscard]] std::optional<std::vector<PlaylistEntry>> filmsIn(const std::string& url);

// The pattern ("a/frame-*.png") that names exactly these pictures, all of one folder: what a shell has spread. nullopt
// if they are fewer than two, or no such series.
[[nodiscard]] std::optional<std::string> seriesOf(const std::vector<std::string>& sources);

}  // namespace relievo
