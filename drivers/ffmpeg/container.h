// SPDX-License-Identifier: Apache-2.0
// Describes an opened container in the types of hal/media/media_source.h.
#pragma once

#include <map>
#include <string>
#include <vector>

extern "C" {
#include <libavformat/avformat.h>
}

#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

inline constexpr AVRational kMicrosecond{1, AV_TIME_BASE};  // the time base of AVFormatContext

// Keys in upper case.
[[nodiscard]] std::map<std::string, std::string> tagsOf(const AVDictionary* dictionary);

// With media times: `start` is the container's (startOf).
[[nodiscard]] std::vector<Chapter> chaptersOf(const AVFormatContext& context, Duration start);

// Other for cover pictures, and for streams that `chooseProgramme` excluded.
[[nodiscard]] StreamKind kindOf(const AVStream& stream) noexcept;

// Without a duration if the container has no times (`timed` false). Exhausted if out of memory.
[[nodiscard]] Result<StreamInfo> describeStream(const AVStream& stream, bool timed, bool photo);

// True for text files, which FFmpeg would render as a video of letters.
[[nodiscard]] bool isTextArt(const AVFormatContext& context) noexcept;

// False for demuxers that need a frame rate (pictures, raw streams): their containers have no times, and the times that
// FFmpeg makes up are ignored.
[[nodiscard]] bool isTimed(const AVFormatContext& context) noexcept;

// The start time of the stream that begins first. It is more exact than FFmpeg's start of the container, which is in
// microseconds, so that the first picture's time becomes exactly 0. Of several programmes only the chosen one counts:
// each has its own clock.
[[nodiscard]] Duration startOf(const AVFormatContext& context) noexcept;

// How long the film is, by the container; 0 if unknown. Matroska and QuickTime may count from time 0, FLV counts from
// the first decoding time; `start` is where the film begins.
[[nodiscard]] Duration lengthOf(const AVFormatContext& context, Duration start) noexcept;

// The leading stream, unless another video stream begins earlier.
[[nodiscard]] int earliestStream(const AVFormatContext& context, int leading) noexcept;

// Keeps only the programme with the best video: the others are other films, or the same one at other bit rates.
void chooseProgramme(AVFormatContext& context) noexcept;

}  // namespace relievo::ffmpeg
