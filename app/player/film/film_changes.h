// SPDX-License-Identifier: Apache-2.0
// What the player shows differently from what the film holds.
#pragma once

#include <string>
#include <vector>

#include "app/media/pair_reader.h"

namespace relievo {

// One line each: fields that are made whole, HDR that is mapped to SDR, wide colour that is
// shown as it is, tracks that are not used.
[[nodiscard]] std::vector<std::string> changesOf(const FilmInfo& film);

}  // namespace relievo
