// SPDX-License-Identifier: Apache-2.0
// Recognises two views of one scene, as opposed to a colour picture and its depth.
#pragma once

#include <optional>
#include <string>

#include "app/media/reading/packing.h"
#include "hal/media/frame.h"

namespace relievo {

// True if most textured blocks of one picture are found in the other, shifted sideways by at most a seventh of
// the width, and all of them up or down by at most a twelfth of the height. A depth picture lacks the colour's texture.
[[nodiscard]] bool areViews(const Frame& first, const Frame& second);

// True if both pictures have texture but share hardly any of it: they are not two views of one scene.
[[nodiscard]] bool areOtherPictures(const Frame& first, const Frame& second);

// StereoSideBySide or StereoTopBottom if the picture's halves are two views of one scene, whichever halves are more
// alike; else nullopt.
[[nodiscard]] std::optional<Packing> findViews(const Frame& picture);

// True if each half lies between two black bars, so that one of each meets at the middle: two wide films, not one.
[[nodiscard]] bool barsMeetInTheMiddle(const Frame& picture, Packing packing);

struct Views {
  Frame left, right;
};
// The two views of a stereo picture, `right_first` or not, in the shape in which they are shown. `squeezed`: each view
// was squeezed by half; nullopt: the picture's shape decides. Nullopt if the picture is too small.
[[nodiscard]] std::optional<Views> viewsOf(const Frame& picture, Packing packing, bool right_first,
                                           std::optional<bool> squeezed = std::nullopt);

}  // namespace relievo
