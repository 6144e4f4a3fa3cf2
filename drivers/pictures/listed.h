// SPDX-License-Identifier: Apache-2.0
// Finds the pictures that the lists of a folder name.
#pragma once

#include <optional>
#include <string>

#include "drivers/pictures/folder.h"
#include "drivers/pictures/lists.h"

namespace relievo::pictures {

// The pairs of `list`, of pictures in `folder`. The time of a pair is that of its colour.
[[nodiscard]] FoundPictures fromAssociations(const std::string& folder, PictureList list);

// By associations.txt, or rgb.txt and depth.txt, in `folder`; nullopt if it has no such lists.
[[nodiscard]] std::optional<FoundPictures> findListed(const std::string& folder);

}  // namespace relievo::pictures
