// SPDX-License-Identifier: Apache-2.0
// Names of the keys of remote controls and keyboards, as in linux/input-event-codes.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace relievo {

// `name`: with or without "KEY_", in upper or lower case. nullopt for an unknown key.
[[nodiscard]] std::optional<std::uint16_t> keyCode(std::string_view name) noexcept;

// Without "KEY_"; empty for an unknown code.
[[nodiscard]] std::string_view keyName(std::uint16_t code) noexcept;

// The name whose spelling is nearest to `word`, ignoring blanks, '-', '_' and case: FASTFORWARD for "fast forward".
// Empty if none is near.
[[nodiscard]] std::string_view nearestKeyName(std::string_view word);

}  // namespace relievo
