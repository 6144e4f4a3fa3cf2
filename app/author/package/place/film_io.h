// SPDX-License-Identifier: Apache-2.0
// A file that FFmpeg's muxers write to. FFmpeg's own would wait for a stalled mount for ever.
#pragma once

extern "C" {
#include <libavformat/avio.h>
}

#include "platform/files/answered_output.h"

namespace relievo {

// Null if memory is out. Flush it before the file is synced. `free` does not flush.
[[nodiscard]] AVIOContext* makeFilmIo(AnsweredOutput file);
// For reading what was written, as MP4's muxer does to move its index to the front.
[[nodiscard]] AVIOContext* makeFilmReader(AnsweredOutput file);
[[nodiscard]] AnsweredOutput& fileOf(AVIOContext& io) noexcept;
void freeFilmIo(AVIOContext*& io) noexcept;

// FFmpeg's code for an error of the file.
[[nodiscard]] int codeOf(const Error& error) noexcept;

}  // namespace relievo
