// SPDX-License-Identifier: Apache-2.0
// Seeks in an HLS film by its list. FFmpeg 5.1 to 7.1 read nothing more after a seek where the parts are MP4: they go
// on at the byte of the whole film that they had reached.
#pragma once

#include <string>
#include <string_view>

#include "platform/clock.h"

extern "C" {
#include <libavformat/avio.h>
}

namespace relievo::ffmpeg {

// A list of parts without those that end at or before `from` of its time, but for the last, and for all from the one
// before the first discontinuity on: their times may begin again. A list of lists, or one that is not ended, stays as
// it is.
[[nodiscard]] std::string laterParts(std::string_view list, Duration from);

// Replaces an I/O context by one that reads the same list without its parts before `from`; the caller closes the first.
// `own`: the list's address, if that is not the one that FFmpeg asks for. Null if out of memory.
[[nodiscard]] AVIOContext* openLaterParts(AVIOContext& list, Duration from, const std::string& own = {});
[[nodiscard]] bool isLaterParts(const AVIOContext* file) noexcept;
void closeLaterParts(AVIOContext* file) noexcept;

}  // namespace relievo::ffmpeg
