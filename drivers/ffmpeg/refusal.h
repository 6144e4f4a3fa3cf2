// SPDX-License-Identifier: Apache-2.0
// Why FFmpeg cannot play what is at an address, for the user.
#pragma once

#include <optional>
#include <string>

#include "drivers/ffmpeg/address.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

// The format of a file that nothing in this build reads, and how to convert it; nullopt for all others. FFmpeg would
// look for films in some of them. It is told by the file's first bytes.
[[nodiscard]] std::optional<Error> unreadFormat(const std::string& path);

// `code` is FFmpeg's, `words` what it printed last.
[[nodiscard]] Error refusal(const Address& address, int code, const std::string& words);

}  // namespace relievo::ffmpeg
