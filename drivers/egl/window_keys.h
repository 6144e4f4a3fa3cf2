// SPDX-License-Identifier: Apache-2.0
// Converts the keys of an SDL window to Linux input event codes.
#pragma once

#include <SDL_keyboard.h>

#include <cstdint>
#include <optional>
#include <string_view>

namespace relievo {

// By the sign that the keyboard's layout makes of it, `typed` with the keys that are held (Shift, AltGr); without one
// by what is printed on the key: as the key of the USA that has this sign (see keyOfSign) or letter. A digit that needs
// Shift, as in France, is a remote control's. KEY_UNKNOWN for another Latin letter or sign, such as ß, and for an
// accent to be typed over a letter. Any other key by its position. nullopt for a key without a Linux code.
[[nodiscard]] std::optional<std::uint16_t> linuxKey(const SDL_Keysym& key, std::string_view typed) noexcept;

}  // namespace relievo
