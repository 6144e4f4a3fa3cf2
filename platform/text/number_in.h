// SPDX-License-Identifier: Apache-2.0
// Numbers in texts.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace relievo {

// The number that is the whole text, in every locale; nullopt if the text is anything else or has more.
template <class T>
[[nodiscard]] std::optional<T> numberIn(std::string_view text) noexcept {
  T value{};
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const auto [last, error] = std::from_chars(begin, end, value);
  return error == std::errc() && last == end ? std::optional(value) : std::nullopt;
}

}  // namespace relievo
