// SPDX-License-Identifier: Apache-2.0
// Rotates pictures: upright those that a camera took on its side or upside down, and as the viewer turns them.
#pragma once

#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// The picture rotated clockwise by so many quarter turns (1 to 3): a copy in memory of its own, one plane per component
// (packed 8-bit RGB stays packed), sample values unchanged. Exhausted if out of memory.
[[nodiscard]] Result<Frame> turned(const Frame& frame, int quarter_turns) noexcept;

}  // namespace relievo
