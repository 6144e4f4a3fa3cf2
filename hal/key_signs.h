// SPDX-License-Identifier: Apache-2.0
// The signs of a keyboard's keys. Letters and digits are no signs.
#pragma once

#include <cstdint>
#include <optional>

namespace relievo {

// The key of the USA that has this sign, with kWithShift where it needs Shift there. `#`, `?`, `<`, `>`, `+` and `*`
// are KEY_NUMERIC_POUND, KEY_QUESTION, KEY_PREVIOUS, KEY_NEXT, KEY_KPPLUS and KEY_KPASTERISK. nullopt for none.
[[nodiscard]] std::optional<std::uint16_t> keyOfSign(int sign) noexcept;
// The sign of that key; '\0' for a key without one.
[[nodiscard]] char signOfKey(std::uint16_t code) noexcept;

}  // namespace relievo
