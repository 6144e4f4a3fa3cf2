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
#include <libavformat/avformat.h>
}

namespace relievo::ffmpeg {

// Whether it is a picture's file, not a film that is coded as pictures are (MJPEG).
[[nodiscard]] bool isOfPhotos(const AVInputFormat& format) noexcept;
// How many samples the codec's pictures may have as they are coded. `photo`: in a picture's file.
[[nodiscard]] std::int64_t mostSamples(AVCodecID codec, bool photo) noexcept;
// Gives the stream of a photo that is too large its halved size; returns a line for the user, or nullopt if it is not.
[[nodiscard]] std::optional<std::string> halveSize(StreamInfo& stream);
// The picture, halved if it is larger than a film's may be.
[[nodiscard]] Result<Frame> withinLimit(Frame frame);

}  // namespace relievo::ffmpeg
