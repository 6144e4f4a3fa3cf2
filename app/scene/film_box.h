// SPDX-License-Identifier: Apache-2.0
// The box that a film fills where none is asked for.
#pragma once

#include "app/scene/display_volume.h"
#include "hal/media/frame.h"

namespace relievo {

// Width over height, as it is to be shown.
[[nodiscard]] double shapeOf(const Frame& picture) noexcept;

// True if the film has the depth's shape: the colour is square and the depth is not. A network's square size is what a
// picture was squeezed to, not what a camera took. `depth` may be empty.
[[nodiscard]] bool hasShapeOfDepth(const Frame& color, const Frame& depth) noexcept;

// The default box, in the colour's shape or, see above, the depth's.
[[nodiscard]] DisplayVolume usualBox(const Frame& color, const Frame& depth) noexcept;

}  // namespace relievo
