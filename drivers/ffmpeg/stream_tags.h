// SPDX-License-Identifier: Apache-2.0
// Reads the tags inside a video stream (hal/media/stream_tags.h).
#pragma once

#include <map>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo::ffmpeg {

// Whether streams of this codec may carry tags.
[[nodiscard]] bool mayCarryTags(AVCodecID codec) noexcept;

// The tags in `packet`; keys in upper case. Empty if there are none, and for other codecs.
[[nodiscard]] std::map<std::string, std::string> streamTags(const AVPacket& packet,
                                                            const AVCodecParameters& parameters);

}  // namespace relievo::ffmpeg
