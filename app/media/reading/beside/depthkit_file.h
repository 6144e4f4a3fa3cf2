// SPDX-License-Identifier: Apache-2.0
// The file that Depthkit writes beside a film.
#pragma once

#include <filesystem>

#include "app/media/reading/recording_place.h"

namespace relievo {

// Looks for FILM.txt, .json or .asset, or the same after FILM_meta. Without a kind if there is none.
[[nodiscard]] RecordingPlace lookForDepthkit(const std::filesystem::path& film);

}  // namespace relievo
