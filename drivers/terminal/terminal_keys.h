// SPDX-License-Identifier: Apache-2.0
// What a terminal sends for its keys, as Linux input event codes.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace relievo {

// Takes the first key off `bytes`; nothing for what is none here (its bytes are taken off all the same). Escape
// sequences as ECMA-48 and xterm have them ("\x1b[C", "\x1bOC", "\x1b[5~"); an escape that nothing follows is the key
// itself. `bytes` is not empty.
[[nodiscard]] std::optional<std::uint16_t> takeTerminalKey(std::string_view& bytes) noexcept;

}  // namespace relievo
