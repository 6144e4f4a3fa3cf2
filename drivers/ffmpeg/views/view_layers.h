// SPDX-License-Identifier: Apache-2.0
// Recognises an HEVC stream that holds two views, each in a layer of its own (MV-HEVC; ITU-T H.265, annex G).
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo::ffmpeg {

// How many views a key frame's packet holds if the stream announces two: 2, or 1 where the second was taken out. 0: it
// announces no second view, or in a way that is not read (with parameters of a buffering model). Any FFmpeg.
[[nodiscard]] int viewLayers(const AVPacket& packet, const AVCodecParameters& parameters);

}  // namespace relievo::ffmpeg
