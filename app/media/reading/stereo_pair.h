// SPDX-License-Identifier: Apache-2.0
// Tells two views of one scene from a colour picture and its depth.
#pragma once

#include <optional>
#include <string>

#include "app/media/reading/packing.h"
#include "hal/media/frame.h"

namespace relievo {

// True if most textured blocks of one picture are found in the other, shifted sideways by at most a seventh of
// the width. A depth picture lacks the colour's texture.
[[nodiscard]] bool areViews(const Frame& first, const Frame& second);

// Whether the picture's halves are two views: side by side, or one above the other.
[[nodiscard]] std::optional<Packing> findViews(const Frame& picture);

}  // namespace relievo
