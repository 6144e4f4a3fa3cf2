// SPDX-License-Identifier: Apache-2.0
// Converts any colour frame to 8-bit 4:2:0.
#pragma once

#include "app/author/package/picture.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// YUV keeps its range and matrix: 8-bit 4:2:0 is unchanged, more bits are rounded, finer chroma is averaged over 2 x 2.
// Gray keeps its range. RGB becomes BT.709 with limited range. InvalidArgument for an odd width or height: the caller
// must crop first, since chroma of 4:2:0 cannot end within a sample.
[[nodiscard]] Result<void> toColor420(const Frame& frame, ColorPicture420& picture);

}  // namespace relievo
