// SPDX-License-Identifier: Apache-2.0
// Converts the keys of an SDL window to Linux input event codes.
#pragma once

#include <SDL_scancode.h>

#include <cstdint>
#include <optional>

namespace relievo {

// By the key's position, whatever is printed on it. nullopt for a key without a Linux code.
[[nodiscard]] std::optional<std::uint16_t> linuxKey(SDL_Scancode scancode) noexcept;

}  // namespace relievo
