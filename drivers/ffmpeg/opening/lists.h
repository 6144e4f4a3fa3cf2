// SPDX-License-Identifier: Apache-2.0
// Looks into lists of parts (RFC 8216) before FFmpeg reads them.
#pragma once

extern "C" {
#include <libavformat/avio.h>
}

namespace relievo::ffmpeg {

// Of a file that was just opened, and stays at its beginning. Whether it is a list, and one of nothing: FFmpeg crashes
// on a film of which one list is such a one. False if more is still to come than its first bytes.
[[nodiscard]] bool isEmptyList(AVIOContext& file) noexcept;

}  // namespace relievo::ffmpeg
