// SPDX-License-Identifier: Apache-2.0
// How a container is sought.
#pragma once

#include "hal/media/media_time.h"
#include "platform/clock.h"

extern "C" {
#include <libavformat/avformat.h>
}

namespace relievo::ffmpeg {

// In a multiplex without an index FFmpeg searches by time and loses the picture that it lands in. To keep the first
// picture, seek to the beginning by byte position.
[[nodiscard]] bool seeksByBytes(const AVFormatContext& context) noexcept;

// Whether the film is a whole list whose parts are MP4: it is sought by its list (later_parts.h).
[[nodiscard]] bool isListOfMp4(const AVFormatContext& context) noexcept;

// Whether each stream has the same kind and codec in both.
[[nodiscard]] bool haveSameStreams(const AVFormatContext& a, const AVFormatContext& b) noexcept;

[[nodiscard]] bool hasSubtitles(const AVFormatContext& context) noexcept;

struct SoughtPlace {
  MediaTime target;
  Duration start, length;         // of the container
  int leading = 0, earliest = 0;  // streams; to the beginning it seeks by the one that begins first
};
// Seeks by key frames. FFmpeg's code.
[[nodiscard]] int seekByKeyFrames(AVFormatContext& context, const SoughtPlace& place) noexcept;

}  // namespace relievo::ffmpeg
