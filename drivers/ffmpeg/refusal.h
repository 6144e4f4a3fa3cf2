// SPDX-License-Identifier: Apache-2.0
// Why FFmpeg cannot play what is at an address, for the user.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "drivers/ffmpeg/address.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo::ffmpeg {

// The format of a file that nothing in this build reads, and how to convert it; nullopt for all others. FFmpeg would
// look for films in some of them. It is told by the file's first bytes.
[[nodiscard]] std::optional<Error> unreadFormat(const std::string& path);

inline constexpr Duration kOpenPatience = std::chrono::seconds(30);  // an index may be long and the connection slow
inline constexpr Duration kReadPatience = std::chrono::seconds(10);
// The error for an opening that took longer than kOpenPatience, or a read that got no data in time.
[[nodiscard]] Error lateOpening(Way way) noexcept;
[[nodiscard]] Error lateReading(Way way) noexcept;

// `code` is FFmpeg's, `words` what it printed last.
[[nodiscard]] Error refusal(const Address& address, int code, const std::string& words);

}  // namespace relievo::ffmpeg
