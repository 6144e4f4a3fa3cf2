// SPDX-License-Identifier: Apache-2.0
// A local file as FFmpeg's I/O context. FFmpeg's own would wait for a stalled mount for ever.
#pragma once

#include <memory>
#include <string>

#include "drivers/ffmpeg/watch.h"
#include "platform/error.h"

extern "C" {
#include <libavformat/avio.h>
}

namespace relievo::ffmpeg {

// The path in "file:a" and in "a"; empty for other addresses.
[[nodiscard]] std::string localPathOf(const std::string& url);

// Fails as AnsweredFile::open, and for a film or picture that exceeds its format's bounds. `watch` must outlive it; it
// learns when the file system does not answer.
[[nodiscard]] Result<AVIOContext*> openLocalFile(const std::string& path, Watch& watch);
// FFmpeg's code for an error of a local file.
[[nodiscard]] int codeOf(const Error& error) noexcept;
[[nodiscard]] bool isLocalFile(const AVIOContext* file) noexcept;
void closeLocalFile(AVIOContext* file) noexcept;

}  // namespace relievo::ffmpeg
