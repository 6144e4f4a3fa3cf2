// SPDX-License-Identifier: Apache-2.0
// Photos of more samples than a film's picture may have.
#pragma once

#include <cstdint>
#include <string>

#include "hal/media/frame.h"
#include "hal/media/video_decoder.h"
#include "platform/error.h"

namespace relievo {

// Of a photo (JPEG, PNG, WebP, HEIC): one of 50 megapixels, of not more than 300 MB as it is decoded, which FFmpeg's
// blocks are bounded to (37 megapixels in four channels of 16 bits). Its decoder halves it, so that it is within the
// limit of all pictures; its stream states the halved size.
inline constexpr std::int64_t kMostOfPhoto = 3 * VideoDecoder::kMostSamples;

// A line for the user about a photo of that size.
[[nodiscard]] std::string halvedLine(int width, int height);

// Every second column and row of `frame`, from the first on, as a copy: codes stay what they are. Unsupported where one
// plane holds unequal numbers of samples of its components (packed 4:2:2), Exhausted if out of memory.
[[nodiscard]] Result<Frame> halved(const Frame& frame);

}  // namespace relievo
