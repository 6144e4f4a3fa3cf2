// SPDX-License-Identifier: Apache-2.0
// Converts the keys of an SDL window to Linux input event codes.
#pragma once

#include <SDL_keyboard.h>

#include <cstdint>
#include <optional>

namespace relievo {

// By what is printed on the key, for letters and the signs `, . - = / ? # [ ] < >`; else by its position, as on a
// keyboard of the USA. `<` and `>` are KEY_PREVIOUS and KEY_NEXT. nullopt for a key without a Linux code.
[[nodiscard]] std::optional<std::uint16_t> linuxKey(const SDL_Keysym& key) noexcept;

}  // namespace relievo
