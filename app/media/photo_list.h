// SPDX-License-Identifier: Apache-2.0
// Lists the photos of a folder that hold their depth, or two views, themselves.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/media/playlist.h"
#include "hal/media/media_source.h"

namespace relievo {

// The photos that the address of `options`, a folder or a pattern, names, as films that stand, if they hold their depth
// or two views each, as those of phones do; with the folder's films, but without the film of such a photo that moves
// ("1.mov" beside "1.heic"). nullopt if none of some that are opened by `make_source` does, if the pictures have depth
// of their own beside them, if the folder is a list of films and none of them is such a photo's, or if the options say
// how the pictures are read: they are one film then.
[[nodiscard]] std::optional<std::vector<PlaylistEntry>> photosIn(
    const SourceOptions& options, const std::function<std::unique_ptr<MediaSource>(const std::string&)>& make_source);

}  // namespace relievo
