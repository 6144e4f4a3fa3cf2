// SPDX-License-Identifier: Apache-2.0
// Ways in which the player shows a film differently from its content.
#pragma once

#include <string>
#include <vector>

#include "app/media/pair_reader.h"

namespace relievo {

// One line each: fields that are deinterlaced, HDR that is mapped to SDR, wide colour that is shown unchanged, tracks
// that are not used.
[[nodiscard]] std::vector<std::string> changesOf(const FilmInfo& film);

}  // namespace relievo
