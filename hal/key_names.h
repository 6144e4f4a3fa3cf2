// SPDX-License-Identifier: Apache-2.0
// Names of the keys of remote controls, keyboards and gamepads, as in linux/input-event-codes.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace relievo {

// Bits that are added to a key's code while Shift or Ctrl is held.
inline constexpr std::uint16_t kWithShift = 0x4000, kWithCtrl = 0x8000;
[[nodiscard]] constexpr std::uint16_t withoutShiftAndCtrl(std::uint16_t code) noexcept {
  return code & static_cast<std::uint16_t>(~(kWithShift | kWithCtrl));
}

// `name`: with or without "KEY_", in upper or lower case; "SHIFT_G", "CTRL_EQUAL". nullopt for an unknown key.
[[nodiscard]] std::optional<std::uint16_t> keyCode(std::string_view name) noexcept;

// Without "KEY_"; "BTN_SOUTH" of a gamepad; empty for an unknown code.
[[nodiscard]] std::string keyName(std::uint16_t code);

// True for a button of a gamepad, by Linux's Documentation/input/gamepad.rst.
[[nodiscard]] bool isPadButton(std::uint16_t code) noexcept;

// The name whose spelling is nearest to `word`, ignoring blanks, '-', '_' and case: FASTFORWARD for "fast forward".
// Empty if none is near.
[[nodiscard]] std::string_view nearestKeyName(std::string_view word);

}  // namespace relievo
