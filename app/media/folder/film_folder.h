// SPDX-License-Identifier: Apache-2.0
// Lists the films of a folder, and finds the depth beside a film.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/media/playlist.h"

namespace relievo {

// The films in the folder `url`, in natural order; nullopt if it is not a folder or not a list of films (a recording
// with a folder `depth`, a series of pictures). At most kMostEntries. A film's depth may lie beside it: `depthBeside`.
[[nodiscard]] std::optional<std::vector<PlaylistEntry>> filmsIn(const std::string& url);
// These files of `folder` as films, in natural order: a file that holds another one's depth is part of that film.
[[nodiscard]] std::vector<PlaylistEntry> pairedFilms(const std::string& folder, std::vector<std::string> names);

// A recording of a colour film and its depth in one folder: a folder of depth pictures, as iPhone scanners write them
// ("rgb.mp4" and "depth"); if it has no other film, also a file of depth by `depthBeside`'s names ("color.mp4" and
// "depth.npy"), or pictures whose names say depth. Or colour pictures and the depth of all of them in one array.
struct FilmOverDepth {
  std::string film, depth;  // paths, or a pattern
};
// nullopt if `folder` is no folder, has no depth, has a folder of colour pictures too, or has no film that is the
// colour by its name or because it is the only one, and no such pictures.
[[nodiscard]] std::optional<FilmOverDepth> filmOverDepth(const std::string& folder);

// The file that by its name holds the depth of the file `film`, in the same folder and of the same kind (film or
// picture): a-depth, a_depth, a.depth, depth-a, depth_a for a; depth_a for color_a, colour_a, rgb_a, image_a or left_a;
// the same with another of kDepthWords (media_names.h) for depth; a_depth or a_vis for a_src or a_input; else names
// such as a_video_depth and a_depth_vis. Small letters and capitals are the same. A film's may be a .npy or .tif too.
// Else the folder of its depth pictures: `filmOverDepth`. A picture's may be a file of its own name, too: a.npy or
// a.png for a.jpg; whether that holds depth, its samples decide. Of a pattern of pictures ("a%04d.color.jpg" or
// "a*.color.jpg"), the pattern of their depth ("a%04d.depth.png"). Empty if there is none.
[[nodiscard]] std::string depthBeside(const std::string& film);

// The photo of a file of numbers: a.jpg for a.npy. Empty if there is none.
[[nodiscard]] std::string photoBeside(const std::string& depth);

}  // namespace relievo
