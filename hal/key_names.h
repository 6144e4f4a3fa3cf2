// SPDX-License-Identifier: Apache-2.0
// The keys of remote controls and keyboards by the names of linux/input-event-codes.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace relievo {

// With or without "KEY_", in either case. Nothing when no remote or keyboard has such a key.
[[nodiscard]] std::optional<std::uint16_t> keyCode(std::string_view name) noexcept;

// Without "KEY_"; empty for a code that no name here has.
[[nodiscard]] std::string_view keyName(std::uint16_t code) noexcept;

// The name that is spelt most like `word`, blanks, '-', '_' and case apart: "fast forward" is FASTFORWARD. Empty when
// none comes near.
[[nodiscard]] std::string_view nearestKeyName(std::string_view word);

}  // namespace relievo
