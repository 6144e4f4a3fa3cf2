// SPDX-License-Identifier: Apache-2.0
// A folder of films as a list; pictures that a shell has listed as one film.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/media/playlist.h"

namespace relievo {

// The films in the folder `url`, in natural order; nullopt if it is no folder or no list of films (a recording with a
// folder `depth`, a series of pictures). At most kMostEntries. A film's depth may lie beside it: `depthBeside`.
[[nodiscard]] std::optional<std::vector<PlaylistEntry>> filmsIn(const std::string& url);
// These files of `folder` as films, in natural order: one that holds another one's depth is part of that film.
[[nodiscard]] std::vector<PlaylistEntry> pairedFilms(const std::string& folder, std::vector<std::string> names);

// The file that by its name holds the depth of the file `film`, in the same folder and of the same kind (film or
// picture): a-depth, a_depth or a.depth for a; depth_a for color_a, colour_a, rgb_a or image_a. Empty if there is none.
[[nodiscard]] std::string depthBeside(const std::string& film);
// Whether the name of the file has the word depth in it, as "clip_depth.mp4"; the folder does not count.
[[nodiscard]] bool saysDepth(const std::string& url);

// The pattern ("a/frame-*.png") that names exactly these pictures, all of one folder: what a shell has spread. nullopt
// if they are fewer than two, or no such series.
[[nodiscard]] std::optional<std::string> seriesOf(const std::vector<std::string>& sources);

}  // namespace relievo
