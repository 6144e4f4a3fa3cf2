// SPDX-License-Identifier: Apache-2.0
// A folder of films as a list.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/media/playlist.h"

namespace relievo {

// The films in the folder `url`, in natural order; nullopt if it is no folder or no list of films (a recording with a
// folder `depth`, a series of pictures). "a-depth.mp4" beside "a.mp4" is that film's depth. At most kMostEntries.
[[nodiscard]] std::optional<std::vector<PlaylistEntry>> filmsIn(const std::string& url);

}  // namespace relievo
