// SPDX-License-Identifier: Apache-2.0
// The description of a LeRobot data set, which says how its depth films are coded.
#pragma once

#include <filesystem>

#include "app/media/reading/recording_place.h"

namespace relievo {

// Looks for meta/info.json above the film, and in it for the camera whose name one of the film's folders has. Without a
// kind if there is none, or if that camera is not one of depth.
[[nodiscard]] RecordingPlace lookForLeRobot(const std::filesystem::path& film);

}  // namespace relievo
