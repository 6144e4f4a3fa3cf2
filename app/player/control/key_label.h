// SPDX-License-Identifier: Apache-2.0
// The names of keys as printed on a keyboard or a remote control.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace relievo {

// What the viewer uses.
enum class KeyBoard : std::uint8_t { Keyboard, Remote, Pad };

// What is printed on a keyboard's key, or typed for it: "f", "]", "Enter", "Page Up". Empty for a key that only remote
// controls have.
[[nodiscard]] std::string keyboardLabel(std::uint16_t code);
// "Pad A or Cross", "Pad Left"; empty for a key that gamepads do not have. Names of Xbox and PlayStation.
[[nodiscard]] std::string padLabel(std::uint16_t code);
// True if remote controls have the key.
[[nodiscard]] bool isOnRemotes(std::uint16_t code) noexcept;
// The label on what the viewer uses; the other's if that has no such key.
[[nodiscard]] std::string keyLabel(std::uint16_t code, KeyBoard held);

// What each mouse action does. `in_list`: in the list of films; `touches`: the mouse is also the finger.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> mouseRows(bool in_list, bool touches);

}  // namespace relievo
