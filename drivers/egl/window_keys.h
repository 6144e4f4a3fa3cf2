// SPDX-License-Identifier: Apache-2.0
// The keys of an SDL window as Linux input codes.
#pragma once

#include <SDL_scancode.h>

#include <cstdint>
#include <optional>

namespace relievo {

// By the key's place, whatever is printed on it. Nothing for a key that Linux has no code for.
[[nodiscard]] std::optional<std::uint16_t> linuxKey(SDL_Scancode scancode) noexcept;

}  // namespace relievo
