// SPDX-License-Identifier: Apache-2.0
// Upright pictures of a track that was taken with the camera on its side or upside down.
#pragma once

#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// The picture, turned clockwise by so many quarter turns (1 to 3): a copy in memory of its own, a plane for each
// component (packed RGB of 8 bits stays packed), every sample with the value it had. Exhausted without memory.
[[nodiscard]] Result<Frame> turned(const Frame& frame, int quarter_turns) noexcept;

}  // namespace relievo
