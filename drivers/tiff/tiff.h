// SPDX-License-Identifier: Apache-2.0
// TIFF pictures of floating-point distances, a renderer's Z buffers, on libtiff.
#pragma once

#include <memory>

#include "hal/video_decoder.h"

namespace relievo {

// A TIFF stream whose pixels the source below could not tell: floats are such.
[[nodiscard]] bool isFloatTiff(const StreamInfo& stream) noexcept;

// A packet is a whole file: one component of 32-bit floats in strips or tiles, compressed by whatever libtiff knows.
// They are taken for metres along the camera's axis, as hal/distance.h has it. Any other picture is damaged.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeTiffDecoder();

}  // namespace relievo
