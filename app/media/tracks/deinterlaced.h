// SPDX-License-Identifier: Apache-2.0
// Makes a picture of one moment from an interlaced one.
#pragma once

#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// The field that was taken first stays; each sample of the other rows becomes the median of itself and the samples
// above and below it in that field. This removes the combs of motion, keeps slopes and edges where nothing moves (but
// no line of a single row), and makes no value that is not in the picture, so that depth keeps its edges and its holes.
// A copy in memory of its own, of the same layout. Exhausted if out of memory.
[[nodiscard]] Result<Frame> deinterlaced(const Frame& frame) noexcept;

}  // namespace relievo
