// SPDX-License-Identifier: Apache-2.0
// Any colour frame as 8-bit 4:2:0.
#pragma once

#include "app/author/package/picture.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// YUV keeps its range and matrix: 8-bit 4:2:0 goes through unchanged, more bits are rounded, finer chroma is averaged
// over two by two. Gray keeps its range. RGB becomes BT.709 of limited range. InvalidArgument for an odd width or
// height: the caller cuts it off (chroma of 4:2:0 cannot end in the middle of a sample).
[[nodiscard]] Result<void> toColor420(const Frame& frame, ColorPicture420& picture);

}  // namespace relievo
