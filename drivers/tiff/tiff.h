// SPDX-License-Identifier: Apache-2.0
// Reads TIFF pictures of numbers (a renderer's Z buffers, disparities) by libtiff.
#pragma once

#include "drivers/floats/picture_file_decoder.h"

namespace relievo {

// Floats of 16, 32 and 64 bits and whole numbers of 8 to 64 bits, of one component or three, in strips or tiles, in any
// compression that libtiff supports.
extern const PictureFormat kTiff;

// True for a TIFF stream whose size FFmpeg could not determine, as with floats.
[[nodiscard]] bool isFloatTiff(const StreamInfo& stream) noexcept;

}  // namespace relievo
