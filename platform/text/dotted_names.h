// SPDX-License-Identifier: Apache-2.0
// TOML's dotted names make a table in a table for each dot, and its library needs stack for each: tens of thousands of
// them crash it.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

namespace relievo {

inline constexpr int kMostDots = 100;  // in a line; names have one, and lists of numbers a dozen

// The first line with more, counted from 1; 0 if there is none.
[[nodiscard]] inline std::uint32_t lineWithTooManyDots(std::string_view text) noexcept {
  std::uint32_t line = 1;
  int dots = 0;
  char before = ' ';
  for (const char c : text) {
    if (c == '.' && std::exchange(before, c) != '.' && ++dots > kMostDots) return line;  // a row of dots is a comment's
    before = c;
    if (c != '\n') continue;
    dots = 0;
    ++line;
  }
  return 0;
}

}  // namespace relievo
