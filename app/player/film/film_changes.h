// SPDX-License-Identifier: Apache-2.0
// What the player shows differently from what the film holds.
#pragma once

#include <string>
#include <vector>

#include "app/media/pair_reader.h"

namespace relievo {

// One line each: fields that are made whole, HDR and wide colour that are shown as they are, tracks that are not used.
[[nodiscard]] std::vector<std::string> changesOf(const FilmInfo& film);

}  // namespace relievo
