// SPDX-License-Identifier: Apache-2.0
// Numbers in texts.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
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

// Reads exactly as many finite numbers as `numbers` holds, with `between` between them; false if the text is anything
// else.
template <class T, std::size_t N>
[[nodiscard]] bool readNumbers(std::string_view text, char between, std::span<T, N> numbers) noexcept {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool last = i + 1 == numbers.size();
    const std::size_t length = last ? text.size() : text.find(between);
    if (length == std::string_view::npos) return false;
    const auto number = numberIn<T>(text.substr(0, length));
    if (!number || !std::isfinite(static_cast<double>(*number))) return false;
    numbers[i] = *number;
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return true;
}

}  // namespace relievo
