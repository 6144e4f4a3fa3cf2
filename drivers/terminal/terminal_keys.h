// SPDX-License-Identifier: Apache-2.0
// Converts a terminal's bytes to Linux input event codes.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace relievo {

// Removes the first key's bytes from `bytes`, which must not be empty, and returns its code; nullopt for an unknown
// key. Understands escape sequences of ECMA-48 and xterm ("\x1b[C", "\x1bOC", "\x1b[5~"); a final escape byte is the
// escape key.
[[nodiscard]] std::optional<std::uint16_t> takeTerminalKey(std::string_view& bytes) noexcept;

}  // namespace relievo
