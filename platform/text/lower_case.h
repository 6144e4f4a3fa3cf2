// SPDX-License-Identifier: Apache-2.0
// Words in small letters, to compare them.
#pragma once

#include <string>
#include <string_view>

namespace relievo {

// Only the letters of ASCII change, in every locale.
[[nodiscard]] inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  return lower;
}

}  // namespace relievo
