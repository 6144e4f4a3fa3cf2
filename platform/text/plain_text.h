// SPDX-License-Identifier: Apache-2.0
// Text for people without commands for their terminal: names and tags of films may hold some.
#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>

namespace relievo {

enum class Lines : std::uint8_t { Keep, Join };

// Replaces control characters by blanks, also those of two bytes (UTF-8 of U+0080 to U+009F). `Keep` spares line
// breaks.
inline void blankControls(std::span<char> text, Lines lines) noexcept {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    const bool of_two = byte == 0xc2 && next >= 0x80 && next < 0xa0;
    const bool kept = byte == '\n' && lines == Lines::Keep;
    if (of_two) text[i] = text[i + 1] = ' ';
    else if ((byte < ' ' && !kept) || byte == 0x7f) text[i] = ' ';
  }
}
// For a name or a tag within a line.
[[nodiscard]] inline std::string oneLine(std::string text) {
  blankControls(text, Lines::Join);
  return text;
}
// To standard output. A failure is found when the program ends (`runProgram`).
inline void say(std::string text) {
  blankControls(text, Lines::Keep);
  std::fputs(text.c_str(), stdout);
}

}  // namespace relievo
