// SPDX-License-Identifier: Apache-2.0
// Names of keys as a viewer reads them on a keyboard or a remote control.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace relievo {

// What the viewer holds.
enum class KeyBoard : std::uint8_t { Keyboard, Remote };

// What is printed on a keyboard's key, or typed for it: "f", "]", "Enter", "Page Up". Empty for a key that only remote
// controls have.
[[nodiscard]] std::string keyboardLabel(std::uint16_t code);
// "OK", "Channel +", "Red"; of a key that keyboards have alone its keyboard's label.
[[nodiscard]] std::string remoteLabel(std::uint16_t code);
// Remote controls have it.
[[nodiscard]] bool isOnRemotes(std::uint16_t code) noexcept;
// Of what the viewer holds; the other's where it has no such key.
[[nodiscard]] std::string keyLabel(std::uint16_t code, KeyBoard held);

// What a window's mouse does and what for. `in_list`: in the list of films; `touches`: it is the finger as well.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> mouseRows(bool in_list, bool touches);

}  // namespace relievo
