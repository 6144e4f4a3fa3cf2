// SPDX-License-Identifier: Apache-2.0
// Words in small letters, to compare them.
#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace relievo {

// Only the letters of ASCII change.
[[nodiscard]] inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace relievo
