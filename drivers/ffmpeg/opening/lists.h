// SPDX-License-Identifier: Apache-2.0
// Looks into lists of parts (RFC 8216) before FFmpeg reads them.
#pragma once

#include <string>
#include <string_view>

extern "C" {
#include <libavformat/avio.h>
}

namespace relievo::ffmpeg {

// Of a file that was just opened, and stays at its beginning. Whether it is a list, and one of nothing: FFmpeg crashes
// on a film of which one list is such a one. False if more is still to come than its first bytes.
[[nodiscard]] bool isEmptyList(AVIOContext& file) noexcept;

// Of a file that was just opened, and stays at its beginning, whatever its name is.
[[nodiscard]] bool isList(AVIOContext& file) noexcept;

// An option of what FFmpeg reads it with, such as where a server has sent it; empty if it has none.
[[nodiscard]] std::string optionOf(AVIOContext& file, const char* name);

// The list with whole addresses, as seen from its own.
[[nodiscard]] std::string withWholeAddresses(std::string_view list, std::string_view own);

}  // namespace relievo::ffmpeg
