// SPDX-License-Identifier: Apache-2.0
// Why FFmpeg cannot play what is at an address, for the user.
#pragma once

#include <string>

#include "drivers/ffmpeg/address.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

// `code` is FFmpeg's, `words` what it printed last.
[[nodiscard]] Error refusal(const Address& address, int code, const std::string& words);

}  // namespace relievo::ffmpeg
