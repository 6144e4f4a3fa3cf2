// SPDX-License-Identifier: Apache-2.0
// Reads the tags that travel in a video stream itself (hal/stream_tags.h).
#pragma once

#include <map>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo::ffmpeg {

// Whether streams of this codec may carry tags.
[[nodiscard]] bool mayCarryTags(AVCodecID codec) noexcept;

// Those beside the picture in `packet`; keys in upper case. Empty for other codecs, and where there are none.
[[nodiscard]] std::map<std::string, std::string> streamTags(const AVPacket& packet,
                                                            const AVCodecParameters& parameters);

}  // namespace relievo::ffmpeg
