// SPDX-License-Identifier: Apache-2.0
// The languages of an HLS film whose tracks lie together in MP4 parts: FFmpeg does not tell them with the list.
#pragma once

extern "C" {
#include <libavformat/avformat.h>
}

namespace relievo::ffmpeg {

// Whether a sound track of the film has no language, although its parts may name it.
[[nodiscard]] bool lacksLanguages(const AVFormatContext& list) noexcept;

// Takes the languages and names of the tracks of `part`, which must be the film's in the same order.
void takeLanguages(AVFormatContext& list, AVIOContext& part) noexcept;

}  // namespace relievo::ffmpeg
