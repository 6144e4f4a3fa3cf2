// SPDX-License-Identifier: Apache-2.0
// Decodes TIFF pictures of floating-point distances (a renderer's Z buffers) by libtiff.
#pragma once

#include <memory>

#include "hal/video_decoder.h"

namespace relievo {

// True for a TIFF stream whose size FFmpeg could not determine, as with floats.
[[nodiscard]] bool isFloatTiff(const StreamInfo& stream) noexcept;

// Each packet is a whole file: one component of 32-bit floats in strips or tiles, in any compression that libtiff
// supports. The floats are interpreted as metres along the camera's axis (hal/distance.h). Any other picture counts as
// damaged.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeTiffDecoder();

}  // namespace relievo
