// SPDX-License-Identifier: Apache-2.0
// What an opened container holds, in the words of hal/media_source.h.
#pragma once

#include <map>
#include <string>

extern "C" {
#include <libavformat/avformat.h>
}

#include "hal/media_source.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

inline constexpr AVRational kMicrosecond{1, AV_TIME_BASE};  // of the times in AVFormatContext

// Keys in upper case.
[[nodiscard]] std::map<std::string, std::string> tagsOf(const AVDictionary* dictionary);

// Other for cover pictures, and for what `chooseProgramme` has left out.
[[nodiscard]] StreamKind kindOf(const AVStream& stream) noexcept;

// Without a duration where the container's times mean nothing (`timed` false). Exhausted without memory.
[[nodiscard]] Result<StreamInfo> describeStream(const AVStream& stream, bool timed);

// The library would show a text file as a film of letters.
[[nodiscard]] bool isTextArt(const AVFormatContext& context) noexcept;

// A demuxer that asks for a frame rate (pictures, raw streams) has no times of its own; those it makes up are left out.
[[nodiscard]] bool isTimed(const AVFormatContext& context) noexcept;

// The library keeps the container's start in microseconds; a stream that begins there says it more exactly, and the
// first picture's time becomes 0, not a fraction of a microsecond beside it.
[[nodiscard]] Duration startOf(const AVFormatContext& context) noexcept;

// The leading stream, unless another video stream begins before it.
[[nodiscard]] int earliestStream(const AVFormatContext& context, int leading) noexcept;

// Of several programmes keeps the one with the best video: the others are other films, or this one at other rates.
void chooseProgramme(AVFormatContext& context) noexcept;

}  // namespace relievo::ffmpeg
