// SPDX-License-Identifier: Apache-2.0
// Photos of more samples than a film's picture may have.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "drivers/ffmpeg/ffmpeg.h"
#include "hal/media/frame.h"
#include "hal/media/media_source.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo::ffmpeg {

// How many samples the codec's pictures may have as they are coded.
[[nodiscard]] std::int64_t mostSamples(AVCodecID codec) noexcept;
// Gives the stream of a photo that is too large its halved size; returns a line for the user, or nullopt if it is not.
[[nodiscard]] std::optional<std::string> halveSize(StreamInfo& stream);
// The picture, halved if it is larger than a film's may be.
[[nodiscard]] Result<Frame> withinLimit(Frame frame);

}  // namespace relievo::ffmpeg
